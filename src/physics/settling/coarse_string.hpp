// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Springs of a string to the first, second and third neighbour, with which few masses have the
/// partials of an ideal string.
struct CoarseFit {
  std::array<double, 3> kappa{};  ///< h^2 k / M, k to the first, second, third neighbour
  std::vector<double> cents;      ///< error of partial 1, 2, ... of those that were asked for
  /// Largest of |cents| over the first `partials`.
  double worstCents(int partials) const;
};

/// Half of the modes are fitted: the others are what a coarse string lacks.
int fittedPartials(int masses);

/// Least squares on the partials f, 2 f, ... of an ideal string, under the explicit scheme:
/// 4 sin^2(w_j h/2) = sum over k of kappa_k (2 - 2 cos(k j pi / (N+1))), relative error.
/// \param masses     N, moving ones, at least 3
/// \param frequency  f h, cycles per step
/// \param partials   3...N
/// \pre partials * frequency < 1/2
CoarseFit fitCoarseString(int masses, double frequency, int partials);

/// Eigenvalue of h^2 M^-1 K of mode j = 1...N: a string holds still if all are positive, and is
/// stable if all are below 4.
double coarseEigenvalue(const CoarseFit& fit, int masses, int mode);

/// Sets the springs of every string that asks for it to the fit at its own step.
/// \throws TextError if a string has less than 3 masses, or a pitch that its rate cannot carry
void fitCoarseStrings(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

}  // namespace ergotic::physics
