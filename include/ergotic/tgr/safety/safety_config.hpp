// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::tgr {

/// Limits of a station's safety chain, the same for every slice. docs/safety.md has the equations
/// and their reasons. Ranges are checked by SafetyChain.
struct SafetyConfig {
  // Force.
  double force_limit_n = 20.0;      ///< per slice, 0...kAbsoluteForceLimitN
  double slew_n_per_s = 5000.0;     ///< |F| grows no faster, 10...1e6; it may fall at once
  double ramp_s = 2.0;              ///< from zero to full gain after engage, 0.1...10
  double resume_ramp_s = 0.05;      ///< the same after a stall or a swap, 0.005...10
  double raw_force_limit_n = 5000;  ///< the model asking for more is a Fault, 1...1e6

  // Position.
  double position_limit_m = 0.1;   ///< |x| of a slice from here on is a bad sample, 0.001...1
  double max_speed_m_per_s = 5.0;  ///< speed limit of a slice; faster is a Fault, 0.1...100
  int max_missing = 20;            ///< ticks a missing sample is held before a Fault, 0...1000
  /// A sensor that gives the very same value for this long is a Fault, 0.001...10; 0: never. Only
  /// for sensors whose noise is larger than their quantum.
  double frozen_s = 0.0;

  // Energy.
  double energy_limit_j = 0.3;  ///< a model that gives out more is a Fault, 0.001...100
  double energy_cap_j = 0.02;  ///< remembered part of the energy that a port dissipated, 0.001...10
  double energy_supply_w = 5e-5;  ///< power that a port may give out of its own, 0...20
  double slice_damping = 0.0;     ///< own damping of a slice, set from the driver, N s/m, 0...100
  bool passivity_controller = false;
  double slice_mass_kg = 0.3;  ///< bounds the damping of the passivity controller, 0.01...100
};

}  // namespace ergotic::tgr
