// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::scene {

/// Converts the units of a scene to those of a step. Velocities inside an instrument are
/// differences of positions over one step; forces stay in the scene's unit (kg m/time_unit^2). At
/// 44.1 kHz an `.mdl` scene has step = 1 exactly, so its coefficients are used as written.
struct Units {
  double step = 1.0;  ///< one step of the section, in time units of the scene

  double inverseMass(double mass) const { return step * step / mass; }
  double damping(double z) const { return z / step; }
  double velocity(double v) const { return v * step; }
  double acceleration(double a) const { return a * step * step; }
};

}  // namespace ergotic::scene
