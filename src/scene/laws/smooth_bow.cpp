// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

double inverseWidth(const LinkInSteps& of) {
  return 1.0 / of.units.velocity(number::width(of));
}

/// f = 0.63 Z v exp(-4 (v/width)^2 + 0.5)
struct SmoothBow {
  static constexpr Number kNumbers[] = {number::damping, inverseWidth};
  static constexpr std::size_t kOffset = 0;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real, Real v) noexcept {
    const Real r = v * c(1, l);
    return {Real(0), Real(0.63) * c(0, l) * v * std::exp(Real(-4) * r * r + Real(0.5))};
  }
};

template <class Real>
struct SmoothBowCurve {
  ERGOTIC_REALTIME static EnergyStableForce<Real> slip(const EnergyStableLaw<Real>& n,
                                                       Real v) noexcept {
    constexpr Real kFar = 64;  // e^-(4 64^2) is 0: nor must it be 0 times infinity
    const Real r = std::min(std::abs(v / n.width), kFar);
    const Real chord = Real(0.63) * n.damping * std::exp(Real(-4) * r * r + Real(0.5));
    return {chord * v, chord * (Real(1) - Real(8) * r * r)};
  }
};

/// 0.63 Z exp(0.5 - 4 r^2) (1 - 8 r^2): steepest at r = 0, falls most where r^2 = 3/8
FrictionSlopes friction(const Scene& scene, const Lia& lia) {
  const double z = largest(scene, lia.damping);
  return {0.63 * std::exp(0.5) * z, 0.63 * 2.0 * std::exp(-1.0) * z};
}

constexpr LawWord kWords[] = {{"smooth_bow", "damping width", ""}};
constexpr LiaField kFields[] = {dampingField(), widthField("width", "m/s")};

}  // namespace

constexpr Law kSmoothBowLaw = frictionLaw<SmoothBow, SmoothBowCurve, friction>(
    {"smooth bow", kWords, kFields, Law::Tables::kNone, false}, never);

}  // namespace ergotic::scene
