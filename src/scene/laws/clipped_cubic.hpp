// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "scene/laws/law.hpp"

namespace ergotic::scene {

/// Meaning of a clipped cubic law in a format: f = K e + Q e^3 up to the tipping point, K_limit e
/// beyond.
enum class ClippedLaw {
  kContinuous,  ///< tipping point sqrt((K_limit - K) / Q), where the two meet
  kMiGen,       ///< the same; springs have 0.3 K_limit more damping beyond, contacts at least K
  kFaust        ///< tipping point sqrt(K_limit - K) / Q, 0.3 K_limit more damping beyond
};

/// Completes a link of type kClippedCubic or kCubicContact; one without a cube, or with K beyond
/// K_limit already, becomes the straight link that it is. Others are left alone.
/// \pre K, Q and K_limit do not depend on parameters
void completeClippedLaw(Lia& lia, ClippedLaw law);

/// Both clipped laws.
struct ClippedCubic {
  static double stiffnessLimit(const LinkInSteps& of) {
    return of.scene.valueOf(of.lia.law->stiffness_limit);
  }
  static double limitDamping(const LinkInSteps& of) {
    return number::damping(of) + of.units.damping(of.scene.valueOf(of.lia.law->limit_damping));
  }
  static double tippingPoint(const LinkInSteps& of) { return of.lia.law->tipping_point; }

  static constexpr Number kNumbers[] = {number::stiffness,    number::damping, number::offset,
                                        number::nonlinearity, stiffnessLimit,  limitDamping,
                                        tippingPoint};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> clipped(const RunNumbers<Real>& c, std::size_t l, Real e, Real v) noexcept {
    return std::abs(e) <= c(6, l) ? Force<Real>{c(0, l) * e + c(3, l) * e * e * e, c(1, l) * v}
                                  : Force<Real>{c(4, l) * e, c(5, l) * v};
  }
  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    return clipped(c, l, u + c(2, l), v);
  }
};

template <class Real>
struct ClippedCurve : PlainDamping<Real> {
  using Numbers = EnergyStableLaw<Real>;
  static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept;
  static Real potential(const Numbers& n, Real p) noexcept;
  static Real damping(const Numbers& n, Real p, Real v) noexcept;
};
extern template struct ClippedCurve<float>;
extern template struct ClippedCurve<double>;

Slopes clippedSlopes(const Scene& scene, const Lia& lia);

/// A clipped law has a tipping point, worked out once, and only if it gets stiffer on the way
/// there.
constexpr LiaField fixedField(const char* key, LiaMember member, const char* unit) {
  return {key, member, {unit, 0.0}, true};
}

}  // namespace ergotic::scene
