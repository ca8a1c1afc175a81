// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::tgr {

/// Detects from outside whether ticks go on, and whether the ticks alone or the whole machine had
/// stopped. Reads no clock itself. Realtime: yes. Thread: one
///
/// Silence is time in which ticks could have run: of the time between two looks at most one
/// `interval` counts. A late look means that the machine, or the process, had stopped, and the
/// ticks with it.
class TickWatch {
 public:
  /// \param period_ns    silence after which ticks count as stopped
  /// \param interval_ns  between two looks, as planned
  TickWatch(std::int64_t period_ns, std::int64_t interval_ns) noexcept
      : period_ns_(period_ns), interval_ns_(interval_ns) {}

  /// Begins to watch with the next tick that it sees.
  void arm() noexcept { state_ = State::kWaiting; }
  void disarm() noexcept { state_ = State::kOff; }
  bool isArmed() const noexcept { return state_ != State::kOff; }

  /// \return true once when ticks have stopped; it is disarmed then
  bool look(std::int64_t now_ns, std::int64_t ticks) noexcept;

  /// Time from the first look that saw the last tick to the last look, by the clock.
  std::int64_t silenceNs() const noexcept { return last_look_ns_ - last_move_ns_; }
  /// Number of looks that came later than planned by more than `period_ns`.
  std::int64_t machineStalls() const noexcept { return machine_stalls_; }
  std::int64_t longestStallNs() const noexcept { return longest_stall_ns_; }

 private:
  enum class State : std::uint8_t { kOff, kWaiting, kWatching };

  std::int64_t period_ns_;
  std::int64_t interval_ns_;
  State state_ = State::kOff;
  bool has_looked_ = false;
  std::int64_t ticks_ = 0;
  std::int64_t last_look_ns_ = 0;
  std::int64_t last_move_ns_ = 0;
  std::int64_t silence_ns_ = 0;  // that counts
  std::int64_t machine_stalls_ = 0;
  std::int64_t longest_stall_ns_ = 0;
};

}  // namespace ergotic::tgr
