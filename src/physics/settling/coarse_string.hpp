// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "ergotic/scene/generate/pitch.hpp"

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

/// Least squares on the partials f, 2 f, ... of an ideal string, the first of them exact, under the
/// explicit scheme: sum over k of kappa_k (2 - 2 cos(k j pi / (N+1))) = scene::modeKappa of partial
/// j, relative error.
/// \param masses     N, moving ones, at least 3
/// \param frequency  f h, cycles per step
/// \param partials   3...N
/// \pre partials * frequency < 1/2, and no mode loses all of its velocity in a step
CoarseFit fitCoarseString(int masses,
                          double frequency,
                          int partials,
                          const scene::StringLoss& loss = {});

/// Eigenvalue of h^2 M^-1 K of mode j = 1...N.
double coarseEigenvalue(const CoarseFit& fit, int masses, int mode);

/// The first mode j whose eigenvalue is not between 0, where the string does not hold still, and 4,
/// where it is unstable; 0: there is none.
int wildMode(const CoarseFit& fit, int masses);

}  // namespace ergotic::physics
