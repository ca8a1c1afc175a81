// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/power_contact.hpp"

#include <algorithm>
#include <cmath>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// f = K e^a + Z v while e > 0
struct PowerContact {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::gapOffset,
                                        number::exponent};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    return e > Real(0) ? Force<Real>{c(0, l) * std::pow(e, c(3, l)), c(1, l) * v} : Force<Real>{};
  }
};

Slopes slopes(const Scene& scene, const Lia& lia) {
  const Range z = rangeOf(scene, lia.damping);
  const bool is_linear = largest(scene, lia.law->exponent) <= 1.0;
  return {{0.0, is_linear ? largest(scene, lia.stiffness) : 0.0},
          {std::min(z.lowest, 0.0), z.highest},
          !is_linear};
}

Growth::Figure figure(const Scene& scene, const Lia& lia) {
  return {"exponent", largest(scene, lia.law->exponent), 1.0};
}

Slopes slopesTo(const Scene& scene, const Lia& lia, double elongation) {
  Slopes to = slopes(scene, lia);
  to.stiffness.highest = powerSlope(scene, lia, elongation);
  return to;
}

constexpr LawWord kWords[] = {{"power_contact", "stiffness exponent", "damping threshold"}};
constexpr LiaField kFields[] = {powerStiffnessField(), dampingField(), exponentField(),
                                thresholdField()};
constexpr Growth kGrowth = {figure, slopesTo, powerElongation};

}  // namespace

template <class Real>
ERGOTIC_REALTIME EnergyStableForce<Real> PowerCurve<Real>::push(const Numbers& n, Real p) noexcept {
  const Real force = n.stiffness * std::pow(p, n.exponent);
  return {force, n.exponent * force / p};
}

template <class Real>
ERGOTIC_REALTIME Real PowerCurve<Real>::potential(const Numbers& n, Real p) noexcept {
  return push(n, p).force * p / (n.exponent + Real(1));
}

template <class Real>
ERGOTIC_REALTIME Real PowerCurve<Real>::potentialIntegral(const Numbers& n, Real p) noexcept {
  return push(n, p).force * p * p / ((n.exponent + Real(1)) * (n.exponent + Real(2)));
}

template <class Real>
ERGOTIC_REALTIME Real PowerCurve<Real>::curvature(const Numbers& n, Real p) noexcept {
  return n.exponent * (n.exponent - Real(1)) * push(n, p).force / (p * p);
}

template struct PowerCurve<float>;
template struct PowerCurve<double>;

double powerSlope(const Scene& scene, const Lia& lia, double elongation) {
  const double a = largest(scene, lia.law->exponent);
  return a * largest(scene, lia.stiffness) * std::pow(elongation, a - 1.0);
}

double powerElongation(const Scene& scene, const Lia& lia, double limit) {
  const double a = largest(scene, lia.law->exponent);
  return std::pow(limit / (a * largest(scene, lia.stiffness)), 1.0 / (a - 1.0));
}

constexpr Law kPowerContactLaw = contactLaw<PowerContact, PowerCurve>(
    {"power-law contact", kWords, kFields, Law::Tables::kNone, false}, slopes, &kGrowth);

}  // namespace ergotic::scene
