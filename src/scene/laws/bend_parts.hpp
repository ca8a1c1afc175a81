// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include <Eigen/Core>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

constexpr int kDigitsOfBends = 12;                                // binary
constexpr double kRoundingOfBends = 1.0 / (1 << kDigitsOfBends);  // of K and Z, at most

/// -u_i u_j of a spring of a bend.
inline double multipleOf(const Scene& scene, const Lia& lia) {
  const Bend& bend = scene.bends[static_cast<std::size_t>(lia.bend)];
  return std::rint(bend.stiffness.factor != 0.0 ? lia.stiffness.factor / bend.stiffness.factor
                                                : lia.damping.factor / bend.damping.factor);
}

/// A power of 2: the last of the digits with which a stiffness or damping of a bend counts.
inline double unitOf(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::ldexp(1.0, exponent - kDigitsOfBends);
}

/// A stiffness or damping of a link in the precision of an instrument. Springs that make up a bend
/// must add up to one load: what rounding takes from each of them by itself would drive a body that
/// nothing holds, as K u u' gives way to its motion. So in single precision K counts with so few
/// digits that all whole multiples -u_i u_j K, and their sums in a net, are exact.
template <class Real>
Real inPrecision(const Scene& scene, const Lia& lia, double value) {
  if (std::is_same_v<Real, double> || lia.bend < 0 || value == 0.0) {
    return static_cast<Real>(value);
  }
  const double multiple = multipleOf(scene, lia);
  const double unit = unitOf(value / multiple);
  return static_cast<Real>(multiple * (std::rint(value / multiple / unit) * unit));
}

/// Difference of the rest positions of a link's ends, as it counts for the elongation, m.
///
/// For the springs of a bend only `c = sum u x` at rest, less its rest length, matters: rest
/// positions of each spring, rounded by themselves, would push a body that nothing holds. So they
/// rest at (u_i - u_j) c / sum u^2 from one another, which is the same force and energy, and 0
/// where the bend is at rest.
inline Eigen::Vector3d restApart(const Scene& scene, const Lia& lia) {
  constexpr double kRounded = 1e-12;  // of what c is the sum of
  const auto restOf = [&](int mat) -> const Eigen::Vector3d& {
    return scene.mats[static_cast<std::size_t>(mat)].rest;
  };
  if (lia.bend < 0) {
    return restOf(lia.a) - restOf(lia.b);
  }
  const Bend& bend = scene.bends[static_cast<std::size_t>(lia.bend)];
  Eigen::Vector3d sum(-bend.rest_length, 0.0, 0.0);
  Eigen::Vector3d size = sum.cwiseAbs();
  double squares = 0.0;
  double difference = 0.0;
  for (const Bend::End& end : bend.ends) {
    const Eigen::Vector3d part = end.weight * restOf(end.mat);
    sum += part;
    size += part.cwiseAbs();
    squares += end.weight * end.weight;
    difference += end.mat == lia.a ? end.weight : end.mat == lia.b ? -end.weight : 0.0;
  }
  const Eigen::Vector3d bent = (sum.cwiseAbs().array() > kRounded * size.array()).select(sum, 0.0);
  return difference / squares * bent + Eigen::Vector3d(lia.rest_length, 0.0, 0.0);
}

}  // namespace ergotic::scene
