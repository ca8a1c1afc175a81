// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>

#include "ergotic/station/messages.hpp"

namespace ergotic::station {

/// The one owner of the state of force: whether it may go out, and why not. Everybody asks here.
///
/// It counts how often force was taken away. Who wants it back says which count was known when that
/// was asked for: a request older than the last stop brings no force, however late it is heard.
/// It outlives stations: an emergency stop before the first of them holds like any other.
/// Realtime: yes. Thread: any
class Interlock {
 public:
  struct Reading {
    Ticket ticket = 0;
    ForceState state = ForceState::kReady;
    FaultReason reason = FaultReason::kNone;  ///< of kFault

    bool isOpen() const noexcept {
      return state == ForceState::kEngaging || state == ForceState::kPlaying;
    }
    bool isLatched() const noexcept { return state == ForceState::kFault; }
  };

  Reading read() const noexcept { return unpacked(word_); }
  /// What a request for force that comes now has to show.
  Ticket ticket() const noexcept { return read().ticket; }

  // What takes force away always succeeds.

  /// No force until an `engage` that is asked for later.
  void stop() noexcept;
  /// No force until a `recover` that is asked for later, and an `engage` after it. The first reason
  /// is the one that is kept.
  void latch(FaultReason reason) noexcept;
  /// Whether all slices in use have a calibration: without, no force and no `engage`.
  void setCalibrated(bool is_calibrated) noexcept;

  // What gives it back does not if force was taken away since it was asked for.

  bool engage(Ticket asked) noexcept;   ///< \return false also if latched or not calibrated
  bool play() noexcept;                 ///< the ramp is over. \return false if no force ramps in
  bool recover(Ticket asked) noexcept;  ///< to kReady, from any state

 private:
  using Word = std::uint64_t;  // ticket, state, reason: they change together

  static Word packed(const Reading& reading) noexcept;
  static Reading unpacked(Word word) noexcept;
  /// \param change  of a Reading; it may be called again. \return what that returned
  template <class Change>
  bool update(Change change) noexcept;

  std::atomic<Word> word_{packed(Reading())};
  static_assert(std::atomic<Word>::is_always_lock_free);
};

}  // namespace ergotic::station
