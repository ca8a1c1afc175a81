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

/// Assigns the hands that can hold any module: a request for a module that is not held gets one of
/// the free hands. Thread: any
class Holders {
 public:
  /// Request to one hand of the station.
  struct Wish {
    std::size_t hand = 0;
    station::Hold hold;
    const station::Performer* model = nullptr;  ///< model that the request is meant for
  };

  /// Resets for another model, of which nothing is held yet.
  /// \param can_be_held  [modules] 1: this one; empty: none, as a person may be at the device
  void play(const station::Performer* model,
            std::vector<std::uint8_t> can_be_held,
            double tick_rate_hz);

  /// \param sender  node, by what it says itself
  /// \return what the hands shall do; nothing if it lets go of what it does not hold
  /// \throws Exception naming field, value and allowed range; nothing has changed then
  std::vector<Wish> read(const HoldTarget& wanted, const std::string& sender, double now_s);

  /// Releases modules whose senders were silent for too long. \return requests to the hands
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
