// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scene/laws/law.hpp"

namespace ergotic::scene {
namespace {

constexpr double kSlope = 0.9;  // of K, while it holds

/// Pushes away, then slips.
struct Pluck {
  static constexpr std::size_t kNumbers = 4;  // K, Z, offset, width
  static constexpr std::size_t kOffset = 2;

  static void convert(
      const Scene& scene, const Lia& lia, const Units& units, double rest, double* to) {
    const CommonNumbers n = commonNumbers(scene, lia, units, rest);
    to[0] = n.stiffness;
    to[1] = n.damping;
    to[2] = n.offset;
    to[3] = scene.valueOf(lia.law->width);
  }

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    const Real distance = std::abs(e);
    const Real width = c(3, l);
    if (distance >= width) {
      return {};
    }
    const Real stiffness = c(0, l);
    const Real slope = Real(0.1) * stiffness;
    const Real tip = Real(0.1) * width;
    const Real friction = c(1, l) * v;
    return {
        distance < tip ? (slope - stiffness) * e : slope * e - std::copysign(tip * stiffness, e),
        friction};
  }
};

const char* unguarded(const Lia& /*lia*/) {
  return "a pluck";
}

Slopes slopes(const Scene& scene, const Lia& lia) {
  return slopesUpTo(kSlope * largest(scene, lia.stiffness), largest(scene, lia.damping));
}

constexpr LawWord kWords[] = {{"pluck", "stiffness width", "damping rest_length"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), widthField("width", "m")};

}  // namespace

constexpr Law kPluckLaw = {
    "pluck",
    kWords,
    kFields,
    Law::Tables::kNone,
    false,  // tables_hold
    false,  // has_release
    Law::Kind::kElastic,
    explicitFormOf<Pluck>(),
    nullptr,  // guarded
    unguarded,
    false,  // has_linear_part
    false,  // switches
    false,  // is_held
    always,
    slopes,
    nullptr,  // growth
    nullptr,  // friction
    noStiffness,
};

}  // namespace ergotic::scene
