// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/position_check.hpp"

#include <cmath>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {

ERGOTIC_REALTIME FaultReason PositionCheck::accept(double& x, std::int64_t ticks) noexcept {
  since_good_ += ticks;
  FaultReason reason = FaultReason::kNone;
  if (!(std::abs(x) < rules_.limit_m)) {  // true for what is not a number
    reason = FaultReason::kBadPosition;
  } else if (knows_last_ &&
             std::abs(x - last_good_) > rules_.max_step_m * static_cast<double>(since_good_)) {
    reason = FaultReason::kJump;
  }
  if (reason != FaultReason::kNone) {
    x = last_good_;
    same_ = 0;
    return reason;
  }
  same_ = knows_last_ && x == last_good_ ? same_ + 1 : 0;
  knows_last_ = true;
  last_good_ = x;
  since_good_ = 0;
  const bool frozen = rules_.frozen_ticks > 0 && same_ >= rules_.frozen_ticks;
  return frozen ? FaultReason::kFrozen : FaultReason::kNone;
}

ERGOTIC_REALTIME void PositionCheck::hold(double& x, std::int64_t ticks) noexcept {
  since_good_ += ticks;
  x = last_good_;
}

ERGOTIC_REALTIME void PositionCheck::forget() noexcept {
  knows_last_ = false;
  since_good_ = 0;
  same_ = 0;
}

}  // namespace ergotic::tgr
