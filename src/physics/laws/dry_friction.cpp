// SPDX-License-Identifier: BSD-3-Clause
#include "physics/laws/dry_friction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ergotic::physics {
namespace {

constexpr int kPasses = 30;  // where two roots are about to meet, each halves what is left

/// The largest g with g + c mu(g) = free, 0 if there is none. Newton's method from above: where mu
/// is convex it cannot pass a root, and where the tangent goes through 0 there is none.
template <class Real>
Real slipOf(const EnergyStableLaw<Real>& law, Real c, Real free) noexcept {
  const Real close = Real(4) * std::numeric_limits<Real>::epsilon() * free;
  Real g = free;
  for (int pass = 0; pass < kPasses && g > Real(0); ++pass) {
    const EnergyStableForce<Real> mu = law.slip(g);
    const Real excess = g + c * mu.force - free;
    const Real slope = Real(1) + c * mu.slope;
    if (std::abs(excess) <= close) {
      return g;
    }
    g = slope > Real(0) ? g - excess / slope : Real(0);
  }
  return g > Real(0) ? g : Real(0);
}

}  // namespace

template <class Real>
Real exertDry(const Slide<Real>& s,
              Real budget,
              const EnergyStableLaw<Real>& law,
              EnergyStableState<Real>& state) noexcept {
  const Real most = s.normal * law.slip(Real(0)).force;
  const bool may_slip = (s.goes_on && state.phase != Real(0)) || s.free > s.give * most;
  const Real slip = may_slip ? slipOf(law, s.give * s.normal, s.free) : Real(0);
  const bool slips = slip > Real(0) || !(s.give > Real(0));
  const Real wanted = slips ? s.normal * law.slip(slip).force : std::min(s.free / s.give, most);
  const Real force = std::min(wanted, largestForce(budget, -(s.before + s.free), s.give));
  state.phase = slips ? Real(1) : Real(0);
  state.active += force > Real(0) ? 1.0 : 0.0;
  state.clipped += force < wanted ? 1.0 : 0.0;
  state.force = Real(0);
  state.damper = force;
  return force;
}

template float exertDry(const Slide<float>&,
                        float,
                        const EnergyStableLaw<float>&,
                        EnergyStableState<float>&) noexcept;
template double exertDry(const Slide<double>&,
                         double,
                         const EnergyStableLaw<double>&,
                         EnergyStableState<double>&) noexcept;

}  // namespace ergotic::physics
