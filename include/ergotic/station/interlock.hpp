// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>

#include "ergotic/station/messages.hpp"

namespace ergotic::station {

/// Owner of the state of the force output: whether force may be output, and if not, why. All other
/// classes ask this one.
///
/// The interlock counts how often force was taken away. A request for force carries the count that
/// was current when it was made: a request older than the last stop has no effect, however late it
/// arrives. The interlock outlives stations: an emergency stop before the first station stays in
/// effect.
/// Realtime: yes. Thread: any
class Interlock {
 public:
  struct Reading {
    Ticket ticket = 0;
    ForceState state = ForceState::kReady;
    FaultReason reason = FaultReason::kNone;  ///< reason of the fault, if `state` is kFault

    bool isOpen() const noexcept {
      return state == ForceState::kEngaging || state == ForceState::kPlaying;
    }
    bool isLatched() const noexcept { return state == ForceState::kFault; }
  };

  Reading read() const noexcept { return unpacked(word_); }
  /// Ticket that a request for force made now has to carry.
  Ticket ticket() const noexcept { return read().ticket; }

  // What takes force away always succeeds.

  /// Stops the force until an `engage` that is requested after this call.
  void stop() noexcept;
  /// Latches a fault: there is no force until a `recover` that is requested after this call, and an
  /// `engage` after it. The first reason is kept.
  void latch(FaultReason reason) noexcept;
  /// Sets whether all slices in use are calibrated; if not, there is no force and `engage` fails.
  void setCalibrated(bool is_calibrated) noexcept;

  // What gives it back does not if force was taken away since it was asked for.

  bool engage(Ticket asked) noexcept;   ///< \return false also if latched or not calibrated
  bool play() noexcept;                 ///< the ramp is over. \return false if no force ramps in
  bool recover(Ticket asked) noexcept;  ///< goes to kReady, from any state

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
