// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::scene {

/// The slopes of a link's force over elongation and over velocity, with every parameter at the
/// worst end of its range. Nonlinear laws: the steepest slope, of either sign, where it is bounded;
/// the linear part where it grows with amplitude.
struct Slopes {
  Range stiffness;
  Range damping;
  bool is_unbounded = false;  ///< grows with amplitude
};
/// Slopes from 0 to `stiffness` and `damping`, whatever their signs.
Slopes slopesUpTo(double stiffness, double damping);

/// Steepest rise and fall of a friction force over velocity, both >= 0.
struct FrictionSlopes {
  double rise = 0.0;
  double fall = 0.0;
};

/// Largest absolute slope of a table, 0 without one.
double steepest(const Table& table);
/// True if a table never falls, or there is none.
bool rises(const Table& table);
/// True if a table over velocity, less what it is at rest, is never against the velocity, or there
/// is none: a constant force and what only brakes.
bool brakes(const Table& table);
/// A damper beside which it nowhere falls, N s/m; 0 if it brakes by itself.
double drive(const Table& table);
/// True if its points are mirrored at (0, 0).
bool isOdd(const Table& table);
FrictionSlopes frictionSlopesOf(const Table& table);

}  // namespace ergotic::scene
