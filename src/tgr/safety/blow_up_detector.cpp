// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/blow_up_detector.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kMinLimitN = 4.0;  // of less a growth is nothing to speak of

}  // namespace

BlowUpDetector::BlowUpDetector(double limit, double raw_limit) noexcept
    : limit_(std::max(limit, kMinLimitN)),
      raw_limit_(raw_limit),
      least_base_(limit_ / 25.0),
      least_change_(limit_ / 4.0) {}

/// \return true if the last changes made it explode
ERGOTIC_REALTIME bool BlowUpDetector::grows(double change) noexcept {
  const bool grew = last_change_ > least_base_ && change >= kGrowth * last_change_;
  growths_ = grew ? std::min(growths_ + 1, kGrowths) : 0;
  last_change_ = change;
  return growths_ == kGrowths && change > least_change_;
}

ERGOTIC_REALTIME FaultReason BlowUpDetector::look(double force) noexcept {
  if (!std::isfinite(force)) {
    forget();
    return FaultReason::kModelBlowUp;
  }
  bool mad = false;
  if (knows_last_) {
    const bool swings = std::min(force, last_) < -limit_ && std::max(force, last_) > limit_;
    mad = (grows(std::abs(force - last_)) && std::abs(force) > limit_) || swings;
  }
  knows_last_ = true;
  last_ = force;
  if (mad) {
    return FaultReason::kModelBlowUp;
  }
  return std::abs(force) > raw_limit_ ? FaultReason::kForceTooHigh : FaultReason::kNone;
}

ERGOTIC_REALTIME void BlowUpDetector::forget() noexcept {
  knows_last_ = false;
  last_change_ = 0.0;
  growths_ = 0;
}

}  // namespace ergotic::tgr
