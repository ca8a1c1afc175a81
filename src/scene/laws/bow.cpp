// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scene/laws/law.hpp"

namespace ergotic::scene {
namespace {

/// Rises by 2/3 Z up to a third of the width, falls by Z/3 beyond.
struct Bow {
  static constexpr std::size_t kNumbers = 2;  // Z, width per step
  static constexpr std::size_t kOffset = 0;

  static void convert(
      const Scene& scene, const Lia& lia, const Units& units, double /*rest*/, double* to) {
    to[0] = units.damping(scene.valueOf(lia.damping));
    to[1] = units.velocity(scene.valueOf(lia.law->width));
  }

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
  ERGOTIC_REALTIME static GuardedForce<Real> slip(const GuardedLaw<Real>& n, Real v) noexcept {
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

const GuardedForms& forms(const Lia& /*lia*/) {
  static constexpr GuardedForms kForms = frictionForms<BowCurve>();
  return kForms;
}

FrictionSlopes friction(const Scene& scene, const Lia& lia) {
  const double z = largest(scene, lia.damping);
  return {z * 2.0 / 3.0, z / 3.0};
}

Slopes slopes(const Scene& scene, const Lia& lia) {
  return slopesUpTo(0.0, friction(scene, lia).rise);
}

constexpr LawWord kWords[] = {{"bow", "damping width", ""}};
constexpr LiaField kFields[] = {dampingField(), widthField("width", "m/s")};

}  // namespace

constexpr Law kBowLaw = {
    "bow",
    kWords,
    kFields,
    Law::Tables::kNone,
    false,  // tables_hold
    false,  // has_release
    Law::Kind::kFriction,
    explicitFormOf<Bow>(),
    forms,
    guardable,
    false,  // has_linear_part
    false,  // switches
    false,  // is_held
    always,
    slopes,
    nullptr,  // growth
    friction,
    noStiffness,
};

}  // namespace ergotic::scene
