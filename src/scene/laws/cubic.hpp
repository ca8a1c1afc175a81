// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/law.hpp"

namespace ergotic::scene {

/// K p + Q p^3, energy-stable; linear springs are those with Q = 0.
template <class Real>
struct CubicCurve : PlainDamping<Real> {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept {
    return {p * (n.stiffness + n.nonlinearity * p * p),
            n.stiffness + Real(3) * n.nonlinearity * p * p};
  }
  ERGOTIC_REALTIME static Real potential(const Numbers& n, Real p) noexcept {
    const Real k = n.stiffness;
    const Real q = n.nonlinearity;
    const bool has_well = k < Real(0) && q > Real(0);
    return p * p * (k / Real(2) + q * p * p / Real(4)) +
           (has_well ? k * k / (Real(4) * q) : Real(0));
  }
};

// Of two-sided springs with K e and a nonlinearity Q.
Slopes springSlopes(const Scene& scene, const Lia& lia);
Growth::Figure nonlinearityFigure(const Scene& scene, const Lia& lia);
double leastSpringStiffness(const Scene& scene, const Lia& lia);

}  // namespace ergotic::scene
