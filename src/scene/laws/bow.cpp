// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

double slipWidth(const LinkInSteps& of) {
  return of.units.velocity(number::width(of));
}

/// Rises by 2/3 Z up to a third of the width, falls by Z/3 beyond.
struct Bow {
  static constexpr Number kNumbers[] = {number::damping, slipWidth};
  static constexpr std::size_t kOffset = 0;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real, Real v) noexcept {
    const Real speed = std::abs(v);
    const Real width = c(1, l);
    if (speed >= width) {
      return {};
    }
    const Real damping = c(0, l);
    const Real slope = damping / Real(3);
    const Real stick = width / Real(3);
    return {Real(0),
            speed < stick ? (damping - slope) * v : std::copysign(stick * damping, v) - slope * v};
  }
};

template <class Real>
struct BowCurve {
  ERGOTIC_REALTIME static EnergyStableForce<Real> slip(const EnergyStableLaw<Real>& n,
                                                       Real v) noexcept {
    const Real speed = std::abs(v);
    const Real slope = n.damping / Real(3);
    const Real stick = n.width / Real(3);
    if (speed >= n.width) {
      return {};
    }
    if (speed < stick) {
      return {(n.damping - slope) * v, n.damping - slope};
    }
    return {std::copysign(stick * n.damping, v) - slope * v, -slope};
  }
};

FrictionSlopes friction(const Scene& scene, const Lia& lia) {
  const double z = largest(scene, lia.damping);
  return {z * 2.0 / 3.0, z / 3.0};
}

constexpr LawWord kWords[] = {{"bow", "damping width", ""}};
constexpr LiaField kFields[] = {dampingField(), widthField("width", "m/s")};

}  // namespace

constexpr Law kBowLaw = frictionLaw<Bow, BowCurve, friction>(
    {"bow", kWords, kFields, Law::Tables::kNone, false}, never);

}  // namespace ergotic::scene
