// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/laws/energy_stable_force.hpp"

/// Friction that sticks. Source: docs/physics/schemes.md, "Friction with stiction".
namespace ergotic::physics {

/// One step of a dry-friction link, along the slip that there would be without it, m per step.
template <class Real>
struct Slide {
  Real free = Real(0);    ///< g_free >= 0, the slip of the step to come
  Real before = Real(0);  ///< d + p, that of the step just made, and by what it was changed since
  Real give = Real(0);    ///< q, how much less it slips per force
  Real normal = Real(0);  ///< N >= 0
  bool goes_on = false;   ///< whether it slips on in the direction of the last step
};

/// The force against the slip, >= 0; the link then slips or sticks.
/// \param budget  the most that its work may be
/// Realtime: yes
template <class Real>
Real exertDry(const Slide<Real>& slide,
              Real budget,
              const EnergyStableLaw<Real>& law,
              EnergyStableState<Real>& state) noexcept;

/// Work that the friction force takes from the motion; below 0 it gives. Realtime: yes
template <class Real>
Real workOf(const Slide<Real>& slide, Real force) noexcept {
  return force * (slide.before + slide.free - slide.give * force) / Real(2);
}

}  // namespace ergotic::physics
