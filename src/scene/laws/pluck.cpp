// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/pluck.hpp"

#include <algorithm>
#include <cmath>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

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

/// A hill of the height 0.045 K width^2: up to its top it holds, beyond it slips.
template <class Real>
struct PluckCurve {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept {
    const Real distance = std::abs(p);
    const Real fall = Real(kPluckTip) * n.stiffness;
    if (distance >= n.width) {
      return {Real(0), Real(0)};
    }
    return distance < Real(kPluckTip) * n.width
               ? EnergyStableForce<Real>{(fall - n.stiffness) * p, fall - n.stiffness}
               : EnergyStableForce<Real>{fall * (p - std::copysign(n.width, p)), fall};
  }
  ERGOTIC_REALTIME static Real potential(const Numbers& n, Real p) noexcept {
    const Real tip = Real(kPluckTip) * n.width;
    const Real distance = std::abs(p);
    const Real slipping = std::max(Real(0), n.width - std::max(distance, tip));
    const Real holding = distance < tip ? (tip - distance) * (tip + distance) : Real(0);
    return Real(kPluckTip / 2.0) * n.stiffness * slipping * slipping +
           Real(kPluckSlope / 2.0) * n.stiffness * holding;
  }
  ERGOTIC_REALTIME static Real damping(const Numbers& n, Real p, Real) noexcept {
    return std::abs(p) < n.width ? std::max(Real(0), n.damping) : Real(0);
  }
};

Slopes slopes(const Scene& scene, const Lia& lia) {
  return slopesUpTo(kPluckSlope * largest(scene, lia.stiffness), largest(scene, lia.damping));
}

constexpr LawWord kWords[] = {
    {"pluck", "stiffness width", "damping rest_length"},
    {"pluck", "release_force", "stiffness damping rest_length", kPluckSlope, kPluckTip}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), widthField("width", "m")};

}  // namespace

constexpr Law kPluckLaw =
    pluckLaw<Pluck, PluckCurve>({"pluck", kWords, kFields, Law::Tables::kNone, false}, slopes);

}  // namespace ergotic::scene
