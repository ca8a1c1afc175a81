// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"
#include "physics/laws/range.hpp"

namespace ergotic::physics {

/// The slopes of a link's force over elongation and over velocity, with every parameter at the
/// worst end of its range. Nonlinear laws: the steepest slope, of either sign, where it is bounded;
/// the linear part where it grows with amplitude.
struct Slopes {
  Range stiffness;
  Range damping;
  bool is_unbounded = false;  ///< grows with amplitude
};
Slopes slopesOf(const scene::Scene& scene, const scene::Lia& lia);

/// The steepest slope up to an elongation, for laws whose slope grows with it.
double stiffnessAt(const scene::Scene& scene, const scene::Lia& lia, double elongation);
/// The elongation from which on the slope of such a law is above a limit, m; 0: always.
double elongationOf(const scene::Scene& scene, const scene::Lia& lia, double limit);

/// Steepest rise and fall of a friction force over velocity, both >= 0.
struct FrictionSlopes {
  double rise = 0.0;
  double fall = 0.0;
};
FrictionSlopes frictionSlopesOf(const scene::Scene& scene, const scene::Lia& lia);

/// True if both tables of an LNL link never fall.
bool isRising(const scene::Lia& lia);

}  // namespace ergotic::physics
