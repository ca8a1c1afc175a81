// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/felt.hpp"

#include <limits>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

template <class Real>
struct FeltCurve : PowerCurve<Real> {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static Real damping(const Numbers& n, Real p, Real) noexcept {
    return n.damping * PowerCurve<Real>::push(n, p).force;
  }
  ERGOTIC_REALTIME static Real restitution(
      const Numbers& n, Real, Real, Real, Real speed) noexcept {
    return static_cast<Real>(feltRestitution(static_cast<double>(n.damping * speed)));
  }
  static constexpr bool kIsLossy = true;
};

bool isLinear(const Scene& scene, const Lia& lia) {
  return largest(scene, lia.law->exponent) <= 1.0 && largest(scene, lia.damping) == 0.0;
}

Slopes slopes(const Scene& scene, const Lia& lia) {
  const bool is_straight = largest(scene, lia.law->exponent) <= 1.0;
  return {{0.0, is_straight ? largest(scene, lia.stiffness) : 0.0}, {}, !isLinear(scene, lia)};
}

Growth::Figure figure(const Scene& scene, const Lia& lia) {
  const double exponent = largest(scene, lia.law->exponent);
  return exponent > 1.0 ? Growth::Figure{"exponent", exponent, 1.0}
                        : Growth::Figure{"damping", largest(scene, lia.damping), 0.0};
}

/// Largest stiffness and damping of a contact at rest at this overlap.
Slopes slopesTo(const Scene& scene, const Lia& lia, double elongation) {
  const double force =
      largest(scene, lia.stiffness) * std::pow(elongation, largest(scene, lia.law->exponent));
  return slopesUpTo(powerSlope(scene, lia, elongation), largest(scene, lia.damping) * force);
}

double elongationOf(const Scene& scene, const Lia& lia, double limit) {
  if (largest(scene, lia.law->exponent) > 1.0) {
    return powerElongation(scene, lia, limit);
  }
  return largest(scene, lia.stiffness) > limit ? 0.0 : std::numeric_limits<double>::infinity();
}

constexpr LawWord kWords[] = {{"felt", "stiffness exponent damping", "threshold"}};
constexpr LiaField kFields[] = {powerStiffnessField(), dampingField(0.0, "s/m"), exponentField(),
                                thresholdField()};
constexpr Growth kGrowth = {figure, slopesTo, elongationOf};

}  // namespace

/// Newton's method from above on a function that is convex there: it cannot overshoot.
ERGOTIC_REALTIME double feltRestitution(double u) noexcept {
  if (!(u > 1e-6)) {
    return 1.0;
  }
  const double lost = u - std::log1p(u);
  double x = std::min(std::sqrt(2.0 * lost), -std::expm1(-lost - 1.0));
  for (int pass = 0; pass < 8 && x < 1.0; ++pass) {
    x -= (-x - std::log1p(-x) - lost) * (1.0 - x) / x;
  }
  return x / u;
}

constexpr Law kFeltLaw = contactLaw<Felt, FeltCurve>(
    {"felt", kWords, kFields, Law::Tables::kNone, false}, slopes, &kGrowth);

}  // namespace ergotic::scene
