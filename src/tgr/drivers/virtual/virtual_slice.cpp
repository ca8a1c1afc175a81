// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_slice.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"
#include "tgr/drivers/virtual/virtual_slice_fields.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

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
  checkSlice(config);
  requireWithin("step", step_s, 1e-6, 0.1, "s");
  constexpr double kWhole = 1e-9;  // of a step: nearer to a whole number of steps is one
  const double whole_steps = std::floor(config.delay / step_s + kWhole);
  const double rest_s = config.delay - whole_steps * step_s;
  const double before_s = rest_s > kWhole * step_s ? rest_s : 0.0;
  parts_ = {makePart(before_s), makePart(step_s - before_s)};
  asked_.assign(static_cast<std::size_t>(whole_steps) + 2, 0.0);
}

VirtualSlice::Part VirtualSlice::makePart(double length_s) const {
  if (length_s == 0.0) {
    return {};
  }
  constexpr double kTwoPi = 6.283185307179586;
  const double tau = 1.0 / (kTwoPi * config_.bandwidth);
  Part part;
  part.substeps = static_cast<int>(std::ceil(length_s / kMaxSubstepS));
  part.substep_s = length_s / part.substeps;
  part.momentum_factor = 2.0 * (config_.mass + config_.hand_mass) / part.substep_s;
  part.inverse_impedance =
      1.0 / (part.momentum_factor + 0.5 * config_.hand_stiffness * part.substep_s +
             config_.damping + config_.hand_damping);
  part.decay = std::exp(-part.substep_s / tau);
  part.mean_share = (1.0 - part.decay) * tau / part.substep_s;
  return part;
}

ERGOTIC_REALTIME void VirtualSlice::step(double force, const HandTarget& target) noexcept {
  const std::size_t count = asked_.size();
  head_ = (head_ + 1) % count;
  asked_[head_] = saturated(force, config_.force_limit);
  const double older = asked_[(head_ + 1) % count];
  const double newer = asked_[(head_ + 2) % count];
  run(parts_[0], older, target, 0.0);
  run(parts_[1], newer, target, parts_[0].substeps * parts_[0].substep_s);
}

ERGOTIC_REALTIME void VirtualSlice::run(const Part& part,
                                        double force,
                                        const HandTarget& target,
                                        double start_s) noexcept {
  for (int i = 0; i < part.substeps; ++i) {
    const double behind = actuator_ - force;
    actuator_ = force + behind * part.decay;
    substep(part, force + behind * part.mean_share + config_.hand_damping * target.velocity,
            target.position + (start_s + (i + 0.5) * part.substep_s) * target.velocity);
  }
}

ERGOTIC_REALTIME void VirtualSlice::substep(const Part& part,
                                            double force,
                                            double target) noexcept {
  const double drive = part.momentum_factor * v_ + force + config_.hand_stiffness * (target - x_);
  const double mean_velocity = afterFriction(drive, config_.dry_friction) * part.inverse_impedance;
  if (mean_velocity == 0.0) {  // friction holds: it stands, and does not swing about zero
    v_ = 0.0;
    return;
  }
  const double x = x_ + part.substep_s * mean_velocity;
  x_ = std::clamp(x, -config_.stop, config_.stop);
  v_ = x_ == x ? 2.0 * mean_velocity - v_ : 0.0;
}

ERGOTIC_REALTIME double VirtualSlice::read() noexcept {
  const double x = x_ + config_.noise_rms * noise_.next();
  return config_.quantum > 0.0 ? config_.quantum * std::round(x / config_.quantum) : x;
}

}  // namespace ergotic::tgr
