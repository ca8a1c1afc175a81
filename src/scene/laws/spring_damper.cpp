// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/cubic.hpp"
#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// f = K e + Z v
struct SpringDamper {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::offset};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    return {c(0, l) * (u + c(2, l)), c(1, l) * v};
  }
};

/// Only a linear spring is refused: with a rest length a link is linear along its line only, and so
/// is every damper.
const char* explicitOnly(const Lia& lia) {
  return lia.rest_length > 0.0 || lia.damping.factor > 0.0 ? nullptr : "a linear spring";
}

Slopes slopes(const Scene& scene, const Lia& lia) {
  return {rangeOf(scene, lia.stiffness), rangeOf(scene, lia.damping)};
}

double leastStiffness(const Scene& scene, const Lia& lia) {
  return rangeOf(scene, lia.stiffness).lowest;
}

constexpr LawWord kWords[] = {{"spring", "stiffness", "rest_length"},
                              {"damper", "damping", ""},
                              {"spring_damper", "stiffness damping", "rest_length"}};
// Any stiffness and damping may be asked for: the certificate judges the whole.
constexpr LiaField kFields[] = {stiffnessField(-kInfinity), dampingField(-kInfinity)};

}  // namespace

constexpr Law kSpringDamperLaw = {
    {"spring-damper", kWords, kFields, Law::Tables::kNone, false},
    Law::Kind::kLinear,
    explicitForm<SpringDamper>(),
    springForms<CubicCurve>,
    explicitOnly,
    true,   // has_linear_part
    false,  // switches
    false,  // is_held
    never,  // canGive
    never,  // givesForEver
    slopes,
    nullptr,  // growth
    nullptr,  // friction
    never,    // onlyBrakes
    leastStiffness,
};

}  // namespace ergotic::scene
