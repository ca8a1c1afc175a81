// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "ergotic/tgr/virtual_driver.hpp"
#include "tgr/sensor_noise.hpp"

namespace ergotic::tgr {

/// Where the hand wants to be at the start of a step, and how fast that moves.
struct HandTarget {
  double position = 0.0;  ///< m
  double velocity = 0.0;  ///< m/s
};

/// The force an actuator gives when `force` is asked of it, N; not a number counts as zero.
double saturated(double force, double limit) noexcept;

/// Mechanics of one virtual slice and its hand, from rest at x = 0.
///
///   M x'' = F + k (target - x) + c (target' - x') - b x' - dry(x'),  M = m + m_hand
///
/// Implicit midpoint rule with the dry friction solved inside the step. With u the mean velocity of
/// the step, the energy M v^2/2 + k (target - x)^2/2 changes by exactly h u (F - (b + c) u) - h dry
/// |u| under a fixed target: friction only ever takes energy, at any step. Where it can hold the
/// slice, the slice stands still. The end stops are rigid and lossy: the slice stops dead on them.
///
/// Realtime: yes, all but the constructor.
class VirtualSlice {
 public:
  /// \param step_s  time that `step` moves on; cut into equal substeps of at most `kMaxSubstepS`
  /// \throws Exception if a setting is outside its range
  VirtualSlice(const VirtualSliceConfig& config, double step_s, std::uint64_t seed);

  /// Moves on by one step with the force held. \param force  N, positive along x
  void step(double force, const HandTarget& target) noexcept;

  /// What the sensor says now, m: with noise, quantised. Every call is a new sample.
  double read() noexcept;

  double position() const noexcept { return x_; }  ///< m, true
  double velocity() const noexcept { return v_; }  ///< m/s, true

  static constexpr double kMaxSubstepS = 50e-6;

 private:
  void substep(double force, double target) noexcept;

  VirtualSliceConfig config_;
  int substeps_;
  double substep_s_;
  double momentum_factor_;    // 2 M / h
  double inverse_impedance_;  // 1 / (2 M / h + k h / 2 + b + c)
  double x_ = 0.0;
  double v_ = 0.0;
  SensorNoise noise_;
};

}  // namespace ergotic::tgr
