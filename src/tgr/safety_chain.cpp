// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety_chain.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {

SafetyChain::SafetyChain(const SafetyConfig& config, int slices, double tick_s)
    : config_(config),
      slices_(slices),
      gain_step_(tick_s / config.ramp_s),
      resume_step_(tick_s / config.resume_ramp_s) {
  requireWithin("force_limit", config.force_limit_n, 0.0, kAbsoluteForceLimitN, "N");
  requireWithin("ramp", config.ramp_s, 0.1, 10.0, "s");
  requireWithin("resume_ramp", config.resume_ramp_s, 0.005, 10.0, "s");
  requireWithin("position_limit", config.position_limit_m, 0.001, 1.0, "m");
  requireWithin("max_missing", config.max_missing, 0, 1000, "ticks");
  requireWithin("slices", slices, 1, kMaxSlices, "");
  requireWithin("tick", tick_s, 1e-6, 0.1, "s");
}

ERGOTIC_REALTIME void SafetyChain::engage() noexcept {
  if (open_ || fault_ != FaultReason::kNone) {
    return;
  }
  gain_ = 0.0;
  open_ = true;
}

ERGOTIC_REALTIME void SafetyChain::disengage() noexcept {
  open_ = false;
  gain_ = 0.0;
}

ERGOTIC_REALTIME void SafetyChain::resume() noexcept {
  resume_gain_ = 0.0;
}

ERGOTIC_REALTIME void SafetyChain::recover() noexcept {
  disengage();
  fault_ = FaultReason::kNone;
  fault_slice_ = -1;
  missing_ = 0;
}

ERGOTIC_REALTIME void SafetyChain::raise(FaultReason fault, int slice) noexcept {
  disengage();
  if (fault_ == FaultReason::kNone) {  // the first cause is the one to tell
    fault_ = fault;
    fault_slice_ = slice;
  }
}

ERGOTIC_REALTIME std::uint64_t SafetyChain::validate(double* positions,
                                                     std::uint32_t flags,
                                                     std::int64_t /*host_missed*/) noexcept {
  if ((flags & (kMissingSample | kDeviceLost)) != 0) {
    if ((flags & kDeviceLost) != 0) {
      raise(FaultReason::kDeviceLost, -1);
    } else if (missing_ >= config_.max_missing) {
      raise(FaultReason::kMissingSamples, -1);
    } else {
      ++missing_;
    }
    std::copy_n(last_good_.begin(), slices_, positions);
    return ~std::uint64_t{0} >> static_cast<unsigned>(kMaxSlices - slices_);
  }
  missing_ = 0;
  std::uint64_t held = 0;
  for (int i = 0; i < slices_; ++i) {
    double& last_good = last_good_[static_cast<std::size_t>(i)];
    if (std::abs(positions[i]) <= config_.position_limit_m) {  // false for NaN
      last_good = positions[i];
    } else {
      positions[i] = last_good;
      held |= std::uint64_t{1} << static_cast<unsigned>(i);
      raise(FaultReason::kBadPosition, i);
    }
  }
  return held;
}

ERGOTIC_REALTIME void SafetyChain::limit(double* forces) noexcept {
  for (int i = 0; i < slices_; ++i) {
    if (!std::isfinite(forces[i])) {
      raise(FaultReason::kModelBlowUp, i);
    }
  }
  if (!open_) {
    std::fill_n(forces, slices_, 0.0);
    return;
  }
  const double bound = config_.force_limit_n;
  const double gain = gain_ * resume_gain_;
  for (int i = 0; i < slices_; ++i) {
    forces[i] = std::clamp(gain * forces[i], -bound, bound);
  }
  gain_ = std::min(1.0, gain_ + gain_step_);
  resume_gain_ = std::min(1.0, resume_gain_ + resume_step_);
}

}  // namespace ergotic::tgr
