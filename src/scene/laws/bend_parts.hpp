// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

constexpr int kDigitsOfBends = 12;                                // binary
constexpr double kRoundingOfBends = 1.0 / (1 << kDigitsOfBends);  // of K and Z, at most

/// A stiffness or damping of a link in the precision of an instrument. Springs that make up a bend
/// must add up to one load: what rounding takes from each of them by itself would drive a body that
/// nothing holds, as K u u' gives way to its motion. So in single precision K counts with so few
/// digits that all whole multiples -u_i u_j K, and their sums in a net, are exact.
template <class Real>
Real inPrecision(const Scene& scene, const Lia& lia, double value) {
  if (std::is_same_v<Real, double> || lia.bend < 0 || value == 0.0) {
    return static_cast<Real>(value);
  }
  const double whole = scene.bends[static_cast<std::size_t>(lia.bend)].stiffness.factor;
  const double damping = scene.bends[static_cast<std::size_t>(lia.bend)].damping.factor;
  const double multiple =
      std::rint(whole != 0.0 ? lia.stiffness.factor / whole : lia.damping.factor / damping);
  int exponent = 0;
  const double digits = std::frexp(value / multiple, &exponent);
  return static_cast<Real>(multiple * std::ldexp(std::rint(std::ldexp(digits, kDigitsOfBends)),
                                                 exponent - kDigitsOfBends));
}

}  // namespace ergotic::scene
