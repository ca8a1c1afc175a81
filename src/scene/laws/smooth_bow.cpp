// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scene/laws/law.hpp"

namespace ergotic::scene {
namespace {

/// f = 0.63 Z v exp(-4 (v/width)^2 + 0.5)
struct SmoothBow {
  static constexpr std::size_t kNumbers = 2;  // Z, 1 / width per step
  static constexpr std::size_t kOffset = 0;

  static void convert(
      const Scene& scene, const Lia& lia, const Units& units, double /*rest*/, double* to) {
    to[0] = units.damping(scene.valueOf(lia.damping));
    to[1] = 1.0 / units.velocity(scene.valueOf(lia.law->width));
  }

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real, Real v) noexcept {
    const Real r = v * c(1, l);
    return {Real(0), Real(0.63) * c(0, l) * v * std::exp(Real(-4) * r * r + Real(0.5))};
  }
};

template <class Real>
struct SmoothBowCurve {
  ERGOTIC_REALTIME static GuardedForce<Real> slip(const GuardedLaw<Real>& n, Real v) noexcept {
    const Real r = v / n.width;
    const Real chord = Real(0.63) * n.damping * std::exp(Real(-4) * r * r + Real(0.5));
    return {chord * v, chord * (Real(1) - Real(8) * r * r)};
  }
};

const GuardedForms& forms(const Lia& /*lia*/) {
  static constexpr GuardedForms kForms = frictionForms<SmoothBowCurve>();
  return kForms;
}

/// 0.63 Z exp(0.5 - 4 r^2) (1 - 8 r^2): steepest at r = 0, falls most where r^2 = 3/8
FrictionSlopes friction(const Scene& scene, const Lia& lia) {
  const double z = largest(scene, lia.damping);
  return {0.63 * std::exp(0.5) * z, 0.63 * 2.0 * std::exp(-1.0) * z};
}

Slopes slopes(const Scene& scene, const Lia& lia) {
  return slopesUpTo(0.0, friction(scene, lia).rise);
}

constexpr LawWord kWords[] = {{"smooth_bow", "damping width", ""}};
constexpr LiaField kFields[] = {dampingField(), widthField("width", "m/s")};

}  // namespace

constexpr Law kSmoothBowLaw = {
    "smooth bow",
    kWords,
    kFields,
    Law::Tables::kNone,
    false,  // tables_hold
    false,  // has_release
    Law::Kind::kFriction,
    explicitFormOf<SmoothBow>(),
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
