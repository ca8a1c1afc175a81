// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/cubic.hpp"

#include <algorithm>
#include <cmath>

namespace ergotic::scene {
namespace {

/// f = K e + Q e^3 + Z v
struct Cubic {
  static constexpr std::size_t kNumbers = 4;  // K, Z, offset, Q
  static constexpr std::size_t kOffset = 2;

  static void convert(
      const Scene& scene, const Lia& lia, const Units& units, double rest, double* to) {
    const CommonNumbers n = commonNumbers(scene, lia, units, rest);
    to[0] = n.stiffness;
    to[1] = n.damping;
    to[2] = n.offset;
    to[3] = scene.valueOf(lia.law->nonlinearity);
  }

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    return {c(0, l) * e + c(3, l) * e * e * e, c(1, l) * v};
  }
};

template <class Real>
struct CubicCurve : PlainDamping<Real> {
  using Numbers = GuardedLaw<Real>;

  ERGOTIC_REALTIME static GuardedForce<Real> push(const Numbers& n, Real p) noexcept {
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

Slopes slopesTo(const Scene& scene, const Lia& lia, double elongation) {
  Slopes slopes = springSlopes(scene, lia);
  slopes.stiffness.highest = largest(scene, lia.stiffness) +
                             3.0 * largest(scene, lia.law->nonlinearity) * elongation * elongation;
  return slopes;
}

double elongationOf(const Scene& scene, const Lia& lia, double limit) {
  return std::sqrt(std::max(limit - largest(scene, lia.stiffness), 0.0) /
                   (3.0 * largest(scene, lia.law->nonlinearity)));
}

constexpr LawWord kWords[] = {{"cubic", "stiffness nonlinearity", "damping rest_length"}};
constexpr LiaField kFields[] = {
    stiffnessField(), dampingField(), {"nonlinearity", &LiaLaw::nonlinearity, {"N/m^3"}}};
constexpr Growth kGrowth = {nonlinearityFigure, slopesTo, elongationOf};

}  // namespace

const GuardedForms& cubicForms(const Lia& /*lia*/) {
  static constexpr GuardedForms kForms = springForms<CubicCurve>();
  return kForms;
}

Slopes springSlopes(const Scene& scene, const Lia& lia) {
  return {rangeOf(scene, lia.stiffness), rangeOf(scene, lia.damping),
          largest(scene, lia.law->nonlinearity) != 0.0};
}

Growth::Figure nonlinearityFigure(const Scene& scene, const Lia& lia) {
  return {"nonlinearity", largest(scene, lia.law->nonlinearity), 0.0};
}

double leastSpringStiffness(const Scene& scene, const Lia& lia) {
  return rangeOf(scene, lia.law->nonlinearity).lowest < 0.0 ? 0.0
                                                            : rangeOf(scene, lia.stiffness).lowest;
}

constexpr Law kCubicLaw = {
    "cubic spring",
    kWords,
    kFields,
    Law::Tables::kNone,
    false,  // tables_hold
    false,  // has_release
    Law::Kind::kElastic,
    explicitFormOf<Cubic>(),
    cubicForms,
    guardable,
    true,   // has_linear_part
    false,  // switches
    false,  // is_held
    never,
    springSlopes,
    &kGrowth,
    nullptr,  // friction
    leastSpringStiffness,
};

}  // namespace ergotic::scene
