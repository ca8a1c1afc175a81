// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include <ergotic/HoldTarget.h>

#include "ergotic/station/messages.hpp"

namespace ergotic::node {

/// [Instrument::touchables] 1: a hand can hold it wherever it is, and it is drawn.
std::vector<std::uint8_t> modulesThatCanBeHeld(const physics::Instrument& instrument);

/// Deals out the hands that can hold any module: who asks for a module that nobody holds gets one
/// of those that are free. Thread: any
class Holders {
 public:
  /// What a hand of the station shall do.
  struct Wish {
    std::size_t hand = 0;
    station::Hold hold;
    const station::Performer* model = nullptr;  ///< that it is meant for
  };

  /// Another model plays, of which nothing is held yet.
  /// \param can_be_held  [modules] 1: this one; empty: none, as a person may be at the device
  void play(const station::Performer* model,
            std::vector<std::uint8_t> can_be_held,
            double tick_rate_hz);

  /// \param sender  node, by what it says itself
  /// \return what the hands shall do; nothing if it lets go of what it does not hold
  /// \throws Exception naming field, value and allowed range; nothing has changed then
  std::vector<Wish> read(const HoldTarget& wanted, const std::string& sender, double now_s);

  /// What senders do not hold any more who were silent for too long.
  std::vector<Wish> expire(double now_s);

 private:
  struct Hand {
    int module = physics::Touch::kNothing;
    std::string sender;
    double heard_s = 0.0;
    double timeout_s = 0.0;  // 0: none
  };
  void check(const HoldTarget& wanted) const;
  std::vector<Wish> release(const HoldTarget& wanted, const std::string& sender);
  std::size_t handFor(int module, const std::string& sender) const;

  std::mutex mutex_;  // of what follows
  const station::Performer* model_ = nullptr;
  std::vector<std::uint8_t> can_be_held_;
  double tick_rate_hz_ = 0.0;
  std::array<Hand, physics::kMaxTouches> hands_;
};

}  // namespace ergotic::node
