// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// What the link remembers: kBehind once its elongation was 0 or less, kPulls while it then pulls
/// up to its width, kSpent after that, until it has come back. It begins as spent.
template <class Real>
struct PluckPhase {
  static constexpr Real kBehind = Real(-1);
  static constexpr Real kSpent = Real(0);
  static constexpr Real kPulls = Real(1);

  ERGOTIC_REALTIME static Real after(Real last, Real e, Real width) noexcept {
    if (e <= Real(0)) {
      return kBehind;
    }
    return last != kSpent && e <= width ? kPulls : kSpent;
  }
};

/// f = K e + Z v while 0 < e <= width, on the way out only.
struct OneWayPluck {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::offset,
                                        number::width};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    const Real e = u + c(2, l);
    Real& phase = c.state[l];
    phase = PluckPhase<Real>::after(phase, e, c(3, l));
    return phase == PluckPhase<Real>::kPulls ? Force<Real>{c(0, l) * e, c(1, l) * v}
                                             : Force<Real>{};
  }
};

/// It stores nothing where it begins to pull nor where it has let go: what it held is lost.
template <class Real>
struct OneWayPluckCurve : PlainDamping<Real> {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept {
    return {n.stiffness * p, n.stiffness};
  }
  ERGOTIC_REALTIME static Real potential(const Numbers&, Real) noexcept { return Real(0); }
  ERGOTIC_REALTIME static Real phase(const Numbers& n, Real p, Real last) noexcept {
    return PluckPhase<Real>::after(last, p, n.width);
  }
  ERGOTIC_REALTIME static Real snap(const Numbers&) noexcept {
    return std::numeric_limits<Real>::max();
  }
};

constexpr LawWord kWords[] = {{"one_way_pluck", "stiffness width", "damping rest_length"},
                              {"one_way_pluck", "release_force", "stiffness damping rest_length"}};
constexpr LiaField kFields[] = {stiffnessField(), dampingField(), widthField("width", "m")};

}  // namespace

constexpr Law kOneWayPluckLaw = snappingLaw<OneWayPluck, OneWayPluckCurve>(
    {"one-way pluck", kWords, kFields, Law::Tables::kNone, false});

}  // namespace ergotic::scene
