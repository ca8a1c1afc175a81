// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/contact.hpp"

#include <algorithm>

namespace ergotic::scene {
namespace {

/// f = K e + Z v while e > 0
struct Contact {
  static constexpr std::size_t kNumbers = 3;  // K, Z, offset (threshold included)
  static constexpr std::size_t kOffset = 2;

  static void convert(
      const Scene& scene, const Lia& lia, const Units& units, double rest, double* to) {
    const CommonNumbers n = commonNumbers(scene, lia, units, rest);
    to[0] = n.stiffness;
    to[1] = n.damping;
    to[2] = n.offset + scene.valueOf(lia.law->width);
  }

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    return e > Real(0) ? Force<Real>{c(0, l) * e, c(1, l) * v} : Force<Real>{};
  }
};

template <class Real>
struct ContactCurve : PlainDamping<Real> {
  using Numbers = GuardedLaw<Real>;

  ERGOTIC_REALTIME static GuardedForce<Real> push(const Numbers& n, Real p) noexcept {
    return {n.stiffness * p, n.stiffness};
  }
  ERGOTIC_REALTIME static Real potential(const Numbers& n, Real p) noexcept {
    return n.stiffness * p * p / Real(2);
  }
  ERGOTIC_REALTIME static Real impulse(const Numbers& n, Real p) noexcept {
    return n.stiffness * p * p * p / Real(6);
  }
  ERGOTIC_REALTIME static Real bend(const Numbers&, Real) noexcept { return Real(0); }
};

const GuardedForms& forms(const Lia& /*lia*/) {
  static constexpr GuardedForms kForms = contactForms<ContactCurve>();
  return kForms;
}

constexpr LawWord kWords[] = {{"contact", "stiffness", "damping threshold"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), thresholdField()};

}  // namespace

Slopes slopesFromZero(const Scene& scene, const Lia& lia) {
  const Range k = rangeOf(scene, lia.stiffness);
  const Range z = rangeOf(scene, lia.damping);
  return {{std::min(k.lowest, 0.0), k.highest}, {std::min(z.lowest, 0.0), z.highest}};
}

constexpr Law kContactLaw = {
    "contact",
    kWords,
    kFields,
    Law::Tables::kNone,
    false,  // tables_hold
    false,  // has_release
    Law::Kind::kGap,
    explicitFormOf<Contact>(),
    forms,
    guardable,
    false,  // has_linear_part
    true,   // switches
    false,  // is_held
    never,
    slopesFromZero,
    nullptr,  // growth
    nullptr,  // friction
    noStiffness,
};

}  // namespace ergotic::scene
