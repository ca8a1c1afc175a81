// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

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

/// A well of the depth K engage^2/2. It stores no more than that where it engages and where it has
/// let go, so what it held beyond is lost.
template <class Real>
struct ConditionalCurve : PlainDamping<Real> {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept {
    return {n.stiffness * p, n.stiffness};
  }
  ERGOTIC_REALTIME static Real potential(const Numbers& n, Real p) noexcept {
    const Real distance = std::min(std::abs(p), n.width);
    return n.stiffness * distance * distance / Real(2);
  }
  ERGOTIC_REALTIME static Real phase(const Numbers& n, Real p, Real last) noexcept {
    const bool holds = last > Real(0) ? std::abs(p) <= n.release : std::abs(p) < n.width;
    return holds ? Real(1) : Real(0);
  }
  ERGOTIC_REALTIME static Real snap(const Numbers& n) noexcept {
    return n.stiffness * (n.release - n.width) * (n.release + n.width) / Real(2);
  }
};

constexpr LawWord kWords[] = {{"conditional", "stiffness engage", "damping release rest_length"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), widthField("engage", "m")};

}  // namespace

constexpr Law kConditionalLaw = snappingLaw<Conditional, ConditionalCurve>(
    {"conditional spring-damper", kWords, kFields, Law::Tables::kNone, true});

}  // namespace ergotic::scene
