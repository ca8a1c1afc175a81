// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_slice.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

void check(const VirtualSliceConfig& c) {
  requireWithin("mass", c.mass, 1e-3, 100.0, "kg");
  requireWithin("damping", c.damping, 0.0, 1e4, "N s/m");
  requireWithin("dry_friction", c.dry_friction, 0.0, 100.0, "N");
  requireWithin("stop", c.stop, 1e-4, 0.1, "m");
  requireWithin("quantum", c.quantum, 0.0, 1e-3, "m");
  requireWithin("noise_rms", c.noise_rms, 0.0, 1e-3, "m");
  requireWithin("force_limit", c.force_limit, 0.0, kAbsoluteForceLimitN, "N");
  requireWithin("hand_mass", c.hand_mass, 0.0, 100.0, "kg");
  requireWithin("hand_stiffness", c.hand_stiffness, 0.0, 1e6, "N/m");
  requireWithin("hand_damping", c.hand_damping, 0.0, 1e4, "N s/m");
}

/// What is left of a drive after dry friction took its share.
double afterFriction(double drive, double dry) noexcept {
  return std::copysign(std::max(std::abs(drive) - dry, 0.0), drive);
}

}  // namespace

ERGOTIC_REALTIME double saturated(double force, double limit) noexcept {
  return std::isnan(force) ? 0.0 : std::clamp(force, -limit, limit);
}

VirtualSlice::VirtualSlice(const VirtualSliceConfig& config, double step_s, std::uint64_t seed)
    : config_(config), noise_(seed) {
  check(config);
  requireWithin("step", step_s, 1e-6, 0.1, "s");
  substeps_ = static_cast<int>(std::ceil(step_s / kMaxSubstepS));
  substep_s_ = step_s / substeps_;
  momentum_factor_ = 2.0 * (config.mass + config.hand_mass) / substep_s_;
  inverse_impedance_ = 1.0 / (momentum_factor_ + 0.5 * config.hand_stiffness * substep_s_ +
                              config.damping + config.hand_damping);
}

ERGOTIC_REALTIME void VirtualSlice::step(double force, const HandTarget& target) noexcept {
  const double drive =
      saturated(force, config_.force_limit) + config_.hand_damping * target.velocity;
  for (int i = 0; i < substeps_; ++i) {
    substep(drive, target.position + (i + 0.5) * substep_s_ * target.velocity);
  }
}

ERGOTIC_REALTIME void VirtualSlice::substep(double force, double target) noexcept {
  const double drive = momentum_factor_ * v_ + force + config_.hand_stiffness * (target - x_);
  const double mean_velocity = afterFriction(drive, config_.dry_friction) * inverse_impedance_;
  if (mean_velocity == 0.0) {  // friction holds: it stands, and does not swing about zero
    v_ = 0.0;
    return;
  }
  const double x = x_ + substep_s_ * mean_velocity;
  x_ = std::clamp(x, -config_.stop, config_.stop);
  v_ = x_ == x ? 2.0 * mean_velocity - v_ : 0.0;
}

ERGOTIC_REALTIME double VirtualSlice::read() noexcept {
  const double x = x_ + config_.noise_rms * noise_.next();
  return config_.quantum > 0.0 ? config_.quantum * std::round(x / config_.quantum) : x;
}

}  // namespace ergotic::tgr
