// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "scene/laws/energy_stable_form.hpp"

namespace ergotic::scene {

/// Energy-stable force of a table over elongation, with a damper or a table over velocity beside
/// it.
template <class Real>
struct TableCurve {
  using Numbers = EnergyStableLaw<Real>;

  ERGOTIC_REALTIME static EnergyStableForce<Real> push(const Numbers& n, Real p) noexcept {
    return n.table.at(p);
  }
  ERGOTIC_REALTIME static Real potential(const Numbers& n, Real p) noexcept {
    return n.table.potential(p);
  }
  ERGOTIC_REALTIME static Real damping(const Numbers& n, Real, Real v) noexcept {
    Real z = n.damping;
    if (!n.viscous.empty()) {
      // The chord, not the slope: it is what this much force dissipates at this velocity. None is
      // steeper than the curve, but where v is no more than rounding it would be.
      const EnergyStableForce<Real> at = n.viscous.at(v * n.per_step);
      const Real chord = v != Real(0) ? at.force / v : at.slope * n.per_step;
      z += std::min(chord, std::max(Real(0), n.viscous.steepest()) * n.per_step);
    }
    return std::max(Real(0), z);
  }
};

/// Energy-stable friction of a table over velocity.
template <class Real>
struct SlipTableCurve {
  ERGOTIC_REALTIME static EnergyStableForce<Real> slip(const EnergyStableLaw<Real>& n,
                                                       Real v) noexcept {
    const EnergyStableForce<Real> at = n.viscous.at(v * n.per_step);
    return {at.force, at.slope * n.per_step};
  }
};

}  // namespace ergotic::scene
