// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/contact.hpp"

#include <algorithm>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// f = K e + Z v while e > 0
struct Contact {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::gapOffset};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    return e > Real(0) ? Force<Real>{c(0, l) * e, c(1, l) * v} : Force<Real>{};
  }
};

template <class Real>
struct ContactCurve : PlainDamping<Real> {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept {
    return {n.stiffness * p, n.stiffness};
  }
  ERGOTIC_REALTIME static Real potential(const Numbers& n, Real p) noexcept {
    return n.stiffness * p * p / Real(2);
  }
  ERGOTIC_REALTIME static Real potentialIntegral(const Numbers& n, Real p) noexcept {
    return n.stiffness * p * p * p / Real(6);
  }
  ERGOTIC_REALTIME static Real curvature(const Numbers&, Real) noexcept { return Real(0); }
};

constexpr LawWord kWords[] = {{"contact", "stiffness", "damping threshold"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), thresholdField()};

}  // namespace

Slopes slopesFromZero(const Scene& scene, const Lia& lia) {
  const Range k = rangeOf(scene, lia.stiffness);
  const Range z = rangeOf(scene, lia.damping);
  return {{std::min(k.lowest, 0.0), k.highest}, {std::min(z.lowest, 0.0), z.highest}};
}

constexpr Law kContactLaw = contactLaw<Contact, ContactCurve>(
    {"contact", kWords, kFields, Law::Tables::kNone, false}, slopesFromZero, nullptr);

}  // namespace ergotic::scene
