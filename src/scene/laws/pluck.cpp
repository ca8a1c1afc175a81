// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

constexpr double kSlope = 0.9;  // of K, while it holds

/// Pushes away, then slips.
struct Pluck {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::offset,
                                        number::width};
  static constexpr std::size_t kOffset = 2;

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

Slopes slopes(const Scene& scene, const Lia& lia) {
  return slopesUpTo(kSlope * largest(scene, lia.stiffness), largest(scene, lia.damping));
}

constexpr LawWord kWords[] = {{"pluck", "stiffness width", "damping rest_length"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), widthField("width", "m")};

}  // namespace

constexpr Law kPluckLaw =
    pluckLaw<Pluck>({"pluck", kWords, kFields, Law::Tables::kNone, false}, slopes);

}  // namespace ergotic::scene
