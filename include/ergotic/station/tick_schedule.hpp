// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::station {

/// Computes when the next tick is due, and what to do now. Reads no clock itself.
///
/// Ticks are due one period apart. If a master clock says otherwise, the due times move towards its
/// own by at most `kMaxSlew` of a period per tick: whatever the master does when it comes, goes or
/// jumps, no tick is skipped or doubled because of it.
///
/// Realtime: yes, all of it. Thread: tick
class TickSchedule {
 public:
  static constexpr double kMaxSlew = 0.05;
  static constexpr std::int64_t kStallTicks = 2;  ///< a due time missed by this many is a stall

  struct Step {
    enum class Kind : std::uint8_t {
      kWait,     ///< until the due time
      kRun,      ///< one tick
      kCatchUp,  ///< all `ticks` that are due
    };
    Kind kind = Kind::kWait;
    std::int64_t ticks = 0;
    std::int64_t late_ns = 0;  ///< now - due, of the first tick to run
  };

  /// \param period_ns     of a tick
  /// \param first_due_ns  when the first one is due
  TickSchedule(double period_ns, std::int64_t first_due_ns) noexcept;

  /// Due time of the next tick, rounded down to ns.
  std::int64_t dueNs() const noexcept { return due_ns_; }

  /// Step to take at the time `now_ns`.
  Step at(std::int64_t now_ns) const noexcept;

  /// `ticks` ticks have run. \pre ticks >= 1
  void advance(std::int64_t ticks) noexcept;

  /// The master clock wants the next tick at `master_due_ns`. Call once per tick, after `advance`.
  void follow(std::int64_t master_due_ns) noexcept;

 private:
  void move(double ns) noexcept;

  double period_ns_;
  std::int64_t due_ns_;
  double fraction_ns_ = 0.0;  // of due_ns_
};

}  // namespace ergotic::station
