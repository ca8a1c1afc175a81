// SPDX-License-Identifier: BSD-3-Clause
#include "physics/laws/matched_cell.hpp"

#include <algorithm>
#include <cmath>

#include "constants.hpp"

namespace ergotic::physics {

double matchedLoad(Range stiffness, Range damping, Range mass, double step) {
  const double slowest_decay = damping.lowest / (2.0 * mass.highest) * step;
  const double fastest_decay = damping.highest / (2.0 * mass.lowest) * step;
  const double zeta = -std::expm1(-2.0 * fastest_decay);
  if (!(stiffness.highest > 0.0)) {
    return 2.0 * zeta * mass.lowest;  // kappa = 0
  }
  // kappa + 2 zeta = 2 + zeta - 2 e^(-s h) cos(wd h)
  const double square = stiffness.highest / mass.lowest * step * step -
                        slowest_decay * slowest_decay;  // of wd h at its largest
  if (square < 0.0) {
    const double root = std::sqrt(-square);
    return mass.lowest *
           (2.0 + zeta - std::exp(root - fastest_decay) - std::exp(-root - fastest_decay));
  }
  // Beyond half the rate the cosine turns back.
  const double cosine = square < kPi * kPi ? std::cos(std::sqrt(square)) : -1.0;
  const double decay = cosine < 0.0 ? slowest_decay : fastest_decay;
  return mass.lowest * (2.0 + zeta - 2.0 * std::exp(-decay) * cosine);
}

}  // namespace ergotic::physics
