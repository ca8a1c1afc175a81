// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scene/laws/cubic.hpp"
#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// f = K e + Q sgn(e) e^2 + Z v
struct Quadratic {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::offset,
                                        number::nonlinearity};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    return {c(0, l) * e + c(3, l) * e * std::abs(e), c(1, l) * v};
  }
};

template <class Real>
struct QuadraticCurve : PlainDamping<Real> {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept {
    const Real size = std::abs(p);
    return {p * (n.stiffness + n.nonlinearity * size),
            n.stiffness + Real(2) * n.nonlinearity * size};
  }
  ERGOTIC_REALTIME static Real potential(const Numbers& n, Real p) noexcept {
    const Real k = n.stiffness;
    const Real q = n.nonlinearity;
    const bool has_well = k < Real(0) && q > Real(0);
    return p * p * (k / Real(2) + q * std::abs(p) / Real(3)) -
           (has_well ? k * k * k / (Real(6) * q * q) : Real(0));
  }
};

Slopes slopesTo(const Scene& scene, const Lia& lia, double elongation) {
  Slopes slopes = springSlopes(scene, lia);
  slopes.stiffness.highest =
      largest(scene, lia.stiffness) + 2.0 * largest(scene, lia.law->nonlinearity) * elongation;
  return slopes;
}

double elongationOf(const Scene& scene, const Lia& lia, double limit) {
  return std::max(limit - largest(scene, lia.stiffness), 0.0) /
         (2.0 * largest(scene, lia.law->nonlinearity));
}

constexpr LawWord kWords[] = {{"quadratic", "stiffness nonlinearity", "damping rest_length"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), nonlinearityField("N/m^2")};
constexpr Growth kGrowth = {nonlinearityFigure, slopesTo, elongationOf};

}  // namespace

constexpr Law kQuadraticLaw = springLaw<Quadratic, QuadraticCurve>(
    {"quadratic spring", kWords, kFields, Law::Tables::kNone, false},
    false,
    springSlopes,
    &kGrowth,
    leastSpringStiffness);

}  // namespace ergotic::scene
