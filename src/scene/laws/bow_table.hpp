// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/guarded_form.hpp"

namespace ergotic::scene {

/// Guarded friction of a table over velocity.
template <class Real>
struct SlipTableCurve {
  ERGOTIC_REALTIME static GuardedForce<Real> slip(const GuardedLaw<Real>& n, Real v) noexcept {
    const GuardedForce<Real> at = n.viscous.at(v * n.per_step);
    return {at.force, at.slope * n.per_step};
  }
};

}  // namespace ergotic::scene
