// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "tgr/sensor_noise.hpp"

namespace ergotic::tgr {

/// Target of the hand at the start of a step, and its velocity.
struct HandTarget {
  double position = 0.0;  ///< m
  double velocity = 0.0;  ///< m/s
  double push = 0.0;      ///< N, feedforward force in addition, for the known path
};

/// Spring and damper of a hand, N/m and N s/m, and the largest force of both together, N.
struct HandHold {
  double stiffness = 0.0;
  double damping = 0.0;
  double max_force = std::numeric_limits<double>::infinity();
};

/// Spring and damper of a grip at a slice: critically damped, or nearly so, with all that moves.
HandHold holdOf(HandGrip grip, const VirtualSliceConfig& slice) noexcept;

/// Force of an actuator when `force` is requested, N; not a number counts as zero.
double saturated(double force, double limit) noexcept;

/// Mechanics of one virtual slice and its hand, from rest at x = 0.
///
///   M x'' = F + hand - b x' - dry(x'),  hand = k (target - x) + c (target' - x') + push
///
/// M = m + m_hand. The hand gives `max_force` at most, and is then a constant force.
///
/// Implicit midpoint rule with the dry friction solved inside the step. With u the mean velocity of
/// the step, the energy M v^2/2 + k (target - x)^2/2 changes by exactly h u (F - (b + c) u) - h dry
/// |u| under a fixed target: friction only ever takes energy, at any step. Where it can hold the
/// slice, the slice stands still. The end stops are rigid and lossy: the slice stops dead on them.
///
/// The force asked for is held over each step, so the actuator's delay and lag are solved exactly:
/// every substep gets the mean of its force, which has the same impulse.
///
/// Realtime: yes, all but the constructor.
class VirtualSlice {
 public:
  /// \param step_s  time that `step` moves on; cut into equal substeps of at most `kMaxSubstepS`
  /// \throws Exception if a setting is outside its range
  VirtualSlice(const VirtualSliceConfig& config, double step_s, std::uint64_t seed);

  /// Moves on by one step with the force held. \param force  asked for, N, positive along x
  void step(double force, const HandTarget& target) noexcept;

  /// Changes spring and damper of the hand from now on; at first they are as configured.
  void hold(const HandHold& hold) noexcept;

  /// Sensor value, m: with noise, quantised. Every call is a new sample.
  double read() noexcept;

  double position() const noexcept { return x_; }  ///< m, true
  double velocity() const noexcept { return v_; }  ///< m/s, true

  static constexpr double kMaxSubstepS = 50e-6;

 private:
  /// Equal substeps of the part of a step in which the actuator has one requested force.
  struct Part {
    int substeps = 0;
    double substep_s = 0.0;          // h
    double momentum_factor = 0.0;    // 2 M / h
    double inverse_impedance = 0.0;  // 1 / (2 M / h + k h / 2 + b + c)
    double decay = 0.0;              // of what the actuator lags behind, exp(-h / tau)
    double mean_share = 0.0;         // of it in the mean over a substep, (1 - decay) tau / h
  };
  Part makePart(double length_s) const;
  double inverseImpedance(const Part& part, const HandHold& hold) const noexcept;
  void run(const Part& part, double force, const HandTarget& target, double start_s) noexcept;
  void substep(const Part& part, double force, const HandTarget& target) noexcept;
  double meanVelocity(const Part& part, double force, const HandTarget& target) const noexcept;

  VirtualSliceConfig config_;
  HandHold hold_;
  std::array<Part, 2> parts_;  // until the delayed change of force, and after it
  std::vector<double> asked_;  // N, of the last steps, newest at head_: as many as the delay needs
  std::size_t head_ = 0;
  double actuator_ = 0.0;  // N
  double x_ = 0.0;
  double v_ = 0.0;
  SensorNoise noise_;
};

}  // namespace ergotic::tgr
