// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "ergotic/tgr/fault.hpp"

namespace ergotic::tgr {

/// Can this be where a slice is? Bad samples are replaced by the last good one. Realtime: yes
///
/// Good is: a number, |x| < limit, no further from the last good one than `max_step` for each tick
/// since, and not the very same value `frozen_ticks` times in a row.
class PositionCheck {
 public:
  struct Rules {
    double limit_m = 0.0;
    double max_step_m = 0.0;        ///< per tick
    std::int64_t frozen_ticks = 0;  ///< 0: a value may stay the same for ever
    std::int64_t still_ticks = 0;   ///< same value for so long: doubtful; 0: never
  };
  explicit PositionCheck(const Rules& rules) noexcept : rules_(rules) {}

  /// A sample came.
  /// \param[in,out] x  m
  /// \param ticks      since the last call, >= 1
  /// \return kNone, kBadPosition, kJump or kFrozen
  FaultReason accept(double& x, std::int64_t ticks) noexcept;

  /// Accounts for a missing sample. \param[out] x  the last good one, m
  void hold(double& x, std::int64_t ticks) noexcept;

  /// Whether the value has been constant for so long that no force should be based on it.
  bool isStill() const noexcept { return rules_.still_ticks > 0 && same_ >= rules_.still_ticks; }

  /// Forgets the last sample: the next good one may be anywhere within the limit.
  void forget() noexcept;

 private:
  Rules rules_;
  bool knows_last_ = false;
  double last_good_ = 0.0;
  std::int64_t since_good_ = 0;  // ticks
  std::int64_t same_ = 0;        // samples in a row
};

}  // namespace ergotic::tgr
