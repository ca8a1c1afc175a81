// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/law.hpp"

namespace ergotic::scene {

/// K p^a with its integrals, energy-stable.
template <class Real>
struct PowerCurve : PlainDamping<Real> {
  using Numbers = EnergyStableLaw<Real>;
  static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept;
  static Real potential(const Numbers& n, Real p) noexcept;
  static Real potentialIntegral(const Numbers& n, Real p) noexcept;
  static Real curvature(const Numbers& n, Real p) noexcept;
};
extern template struct PowerCurve<float>;
extern template struct PowerCurve<double>;

/// K of power laws, and their exponent.
constexpr LiaField powerStiffnessField() {
  return stiffnessField(0.0, "N/m^exponent");
}
constexpr LiaField exponentField() {
  return {"exponent", &LiaLaw::exponent, kExponentLimits};
}

/// a K e^(a - 1), at the worst ends of K and a.
double powerSlope(const Scene& scene, const Lia& lia, double elongation);
/// Elongation at which that slope reaches a limit. \pre a > 1
double powerElongation(const Scene& scene, const Lia& lia, double limit);

}  // namespace ergotic::scene
