// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/cubic.hpp"

#include <algorithm>
#include <cmath>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// f = K e + Q e^3 + Z v
struct Cubic {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::offset,
                                        number::nonlinearity};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    return {c(0, l) * e + c(3, l) * e * e * e, c(1, l) * v};
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
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), nonlinearityField("N/m^3")};
constexpr Growth kGrowth = {nonlinearityFigure, slopesTo, elongationOf};

}  // namespace

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

constexpr Law kCubicLaw =
    springLaw<Cubic, CubicCurve>({"cubic spring", kWords, kFields, Law::Tables::kNone, false},
                                 false,
                                 springSlopes,
                                 &kGrowth,
                                 leastSpringStiffness);

}  // namespace ergotic::scene
