// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_slice.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"
#include "tgr/drivers/virtual/virtual_slice_fields.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

/// Driving force minus dry friction, 0 if friction is larger.
double afterFriction(double drive, double dry) noexcept {
  return std::copysign(std::max(std::abs(drive) - dry, 0.0), drive);
}

}  // namespace

ERGOTIC_REALTIME HandHold holdOf(HandGrip grip, const VirtualSliceConfig& slice) noexcept {
  struct Figures {
    double stiffness, damping_ratio, max_force;
  };
  constexpr Figures kSoft{500.0, 1.0, 5.0};
  constexpr Figures kFirm{1500.0, 0.8, 10.0};
  constexpr Figures kQuick{3000.0, 1.0, 20.0};
  constexpr Figures kKey{5000.0, 1.0, 60.0};
  if (grip == HandGrip::kConfigured) {
    return {slice.hand_stiffness, slice.hand_damping};
  }
  const Figures& figures = grip == HandGrip::kSoft    ? kSoft
                           : grip == HandGrip::kFirm  ? kFirm
                           : grip == HandGrip::kQuick ? kQuick
                                                      : kKey;
  const double critical = 2.0 * std::sqrt(figures.stiffness * (slice.mass + slice.hand_mass));
  return {figures.stiffness, std::max(figures.damping_ratio * critical - slice.damping, 0.0),
          figures.max_force};
}

ERGOTIC_REALTIME double saturated(double force, double limit) noexcept {
  return std::isnan(force) ? 0.0 : std::clamp(force, -limit, limit);
}

VirtualSlice::VirtualSlice(const VirtualSliceConfig& config, double step_s, std::uint64_t seed)
    : config_(config), hold_(holdOf(HandGrip::kConfigured, config)), noise_(seed) {
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
  part.inverse_impedance = inverseImpedance(part, hold_);
  part.decay = std::exp(-part.substep_s / tau);
  part.mean_share = (1.0 - part.decay) * tau / part.substep_s;
  return part;
}

ERGOTIC_REALTIME double VirtualSlice::inverseImpedance(const Part& part,
                                                       const HandHold& hold) const noexcept {
  return 1.0 / (part.momentum_factor + 0.5 * hold.stiffness * part.substep_s + config_.damping +
                hold.damping);
}

ERGOTIC_REALTIME void VirtualSlice::hold(const HandHold& hold) noexcept {
  hold_ = hold;
  for (Part& part : parts_) {
    if (part.substeps > 0) {
      part.inverse_impedance = inverseImpedance(part, hold_);
    }
  }
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
    substep(part, force + behind * part.mean_share,
            {target.position + (start_s + (i + 0.5) * part.substep_s) * target.velocity,
             target.velocity, target.push});
  }
}

/// \param target  in the middle of the substep
ERGOTIC_REALTIME double VirtualSlice::meanVelocity(const Part& part,
                                                   double force,
                                                   const HandTarget& target) const noexcept {
  const double drive = part.momentum_factor * v_ + (force + hold_.damping * target.velocity) +
                       hold_.stiffness * (target.position - x_) + target.push;
  const double mean = afterFriction(drive, config_.dry_friction) * part.inverse_impedance;
  const double hand = hold_.stiffness * (target.position - x_ - 0.5 * part.substep_s * mean) +
                      hold_.damping * (target.velocity - mean) + target.push;
  if (std::abs(hand) <= hold_.max_force) {
    return mean;
  }
  const double pushed = part.momentum_factor * v_ + force + std::copysign(hold_.max_force, hand);
  return afterFriction(pushed, config_.dry_friction) / (part.momentum_factor + config_.damping);
}

ERGOTIC_REALTIME void VirtualSlice::substep(const Part& part,
                                            double force,
                                            const HandTarget& target) noexcept {
  const double mean_velocity = meanVelocity(part, force, target);
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
