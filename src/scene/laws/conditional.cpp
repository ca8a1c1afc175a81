// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scene/laws/contact.hpp"
#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

double release(const LinkInSteps& of) {
  return of.lia.law->release;
}

/// f = K e + Z v from when |e| < engage until |e| > release.
struct Conditional {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::offset,
                                        number::width, release};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    Real& engaged = c.state[l];  // 1 while it holds on
    const Real e = u + c(2, l);
    const Real distance = std::abs(e);
    const bool holds = engaged != Real(0) ? distance <= c(4, l) : distance < c(3, l);
    engaged = holds ? Real(1) : Real(0);
    return holds ? Force<Real>{c(0, l) * e, c(1, l) * v} : Force<Real>{};
  }
};

const char* unguarded(const Lia& /*lia*/) {
  return "conditional";
}

constexpr LawWord kWords[] = {{"conditional", "stiffness engage", "damping release rest_length"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), widthField("engage", "m")};

}  // namespace

constexpr Law kConditionalLaw = {
    {"conditional spring-damper", kWords, kFields, Law::Tables::kNone, true},
    Law::Kind::kElastic,
    explicitForm<Conditional>(true),
    nullptr,  // guarded
    unguarded,
    false,   // has_linear_part
    true,    // switches
    true,    // is_held
    always,  // canGive
    never,   // givesForEver
    slopesFromZero,
    nullptr,  // growth
    nullptr,  // friction
    never,    // onlyBrakes
    noStiffness,
};

}  // namespace ergotic::scene
