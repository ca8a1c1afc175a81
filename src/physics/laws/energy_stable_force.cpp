// SPDX-License-Identifier: BSD-3-Clause
#include "physics/laws/energy_stable_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ergotic::physics {
namespace {

constexpr double kEmptyTank = 1e-6;
constexpr double kShortContact = 3.0;  // kt above which a contact is over before a sample sees it

/// How far ahead the law is taken. 1/12 cancels the second-order error of the step in time and
/// energy; 1/4 - 1/(2 kt) is the least that is stable on a stiffness that does not change.
template <class Real>
Real lookAhead(Real kt, bool is_contact) noexcept {
  if (kt > Real(kShortContact)) {
    return Real(0.25) - Real(1) / (Real(2) * kt);
  }
  // At given amplitude a two-sided spring is more accurate without.
  return is_contact || kt > Real(1) ? Real(1) / Real(12) : Real(0);
}

template <class Real>
void lose(Real energy, EnergyStableState<Real>& state) noexcept {
  state.lost += static_cast<double>(energy);
  state.tank -= energy;
}

/// A damped contact so short that a damper would never see it: restitution takes its place. Where
/// the link turns from closing to opening, its tank keeps e^2 of what it holds.
/// \param e  restitution at a speed per step
template <class Real, class Restitution>
Real rebound(EnergyStableMotion<Real>& m,
             const Restitution& e,
             Real wanted,
             EnergyStableState<Real>& state) noexcept {
  // Empty but for rounding, against the energy of the motion.
  const bool is_empty =
      m.give * state.tank <= Real(kEmptyTank) * m.coasting * m.coasting && m.give > Real(0);
  if (is_empty && m.coasting < Real(0)) {
    // It closes and could not open on its own: this step stands for the whole impact.
    state.lost += static_cast<double>(state.tank);
    state.tank = Real(0);
    state.phase = Real(0);
    const Real load = m.opening - m.coasting;
    const Real high =
        (-load - m.coasting * (Real(1) + e(-m.coasting / Real(2))) / Real(2)) / m.give;
    m.forfeits = wanted > high;
    return std::max(Real(0), high);
  }
  Real high = largestForce(state.tank, m.opening, m.give);
  const bool is_opening = m.opening + m.give * std::clamp(wanted, Real(0), high) > Real(0);
  if (is_opening && state.phase == Real(0)) {
    const Real ratio =
        e(std::sqrt(Real(2) * m.own_give * state.tank));  // all motion is in the tank
    const Real kept = ratio * ratio * state.tank;
    state.lost += static_cast<double>(state.tank - kept);
    state.tank = kept;
    high = largestForce(kept, m.opening, m.give);
  }
  state.phase = is_opening ? Real(1) : Real(0);
  return high;
}

/// True if what presses the link holds it so deep at rest that it will not let go while it swings.
template <class Real>
bool isHeld(const EnergyStableMotion<Real>& m, Real slope) noexcept {
  const Real load = m.coasting - m.opening;
  return load > m.give * slope * std::abs(m.coasting);
}

/// The force that lets the link move no further.
template <class Real>
Real stoppingForce(const EnergyStableMotion<Real>& m) noexcept {
  return std::max(Real(0), (m.coasting / Real(2) - m.opening) / m.give);
}

/// The force of the law a little ahead.
template <class Real>
Real wantedForce(const EnergyStableMotion<Real>& m,
                 const EnergyStableForce<Real>& at,
                 Real kt,
                 bool is_contact) noexcept {
  const Real ahead = lookAhead(kt, is_contact);
  return (at.force - ahead * at.slope * (m.opening - m.coasting)) / (Real(1) + ahead * kt);
}

/// The wanted force of a contact that lasts for several steps. Its slope changes when the contact
/// closes, at a time between two samples; the mean of the law over the steps before and after,
/// which is what the motion feels, accounts for that. It depends on the velocity, hence the passes.
template <class Real>
Real wantedMean(const EnergyStableMotion<Real>& m,
                const EnergyStableLaw<Real>& law,
                EnergyStableForce<Real> at,
                Real kt) noexcept {
  Real wanted = at.force;
  for (int pass = 0; pass < 3; ++pass) {
    at.force = law.meanPush(m.p, (m.opening + m.give * wanted) / Real(2));
    wanted = wantedForce(m, at, kt, true);
  }
  return wanted;
}

/// A contact f (1 + c v) that lasts for several steps.
template <class Real>
struct Lossy {
  Real wanted;   ///< elastic force
  Real z;        ///< of the damper
  Real surplus;  ///< what the tank would keep of this step although it is lost
};

/// The mean of c f v = c dU/dt over the steps on both sides is c v times that of f, and more where
/// the velocity changes. What centred steps take for the work of f is too much by h^2 c f f'
/// v^2/4M, with f f' v = d(f^2)/2dt.
template <class Real>
Lossy<Real> wantedLossy(const EnergyStableMotion<Real>& m,
                        const EnergyStableLaw<Real>& law,
                        const EnergyStableForce<Real>& at,
                        Real kt,
                        Real z) noexcept {
  const Real c = law.damping;
  const Real ahead = lookAhead(kt, true);
  const auto squareAt = [&law](Real p) {
    const Real force = p > Real(0) ? law.push(p).force : Real(0);
    return force * force;
  };
  Lossy<Real> to{at.force, z, Real(0)};
  for (int pass = 0; pass < 4; ++pass) {
    const Real swing = (m.opening + m.give * to.wanted) / (Real(1) + m.give * to.z / Real(2));
    const Real v = -swing / Real(2);       // of the overlap
    const Real turn = m.coasting - swing;  // how much v changes in a step
    const Real mean = law.meanPush(m.p, v);
    const Real braked = m.opening - m.give * to.z * swing / Real(2);
    to.wanted = (mean - ahead * at.slope * (braked - m.coasting)) / (Real(1) + ahead * kt);
    const Real square = v * v + turn * turn;
    const Real per_v = square > Real(0) ? turn * v / square : Real(0);  // not where v turns
    const Real jerk = m.give * at.force * (at.slope * (Real(1) + c * v) + c * at.force * per_v);
    to.z = c * std::max(Real(0), mean + (Real(3) * at.slope * turn + jerk) / Real(12));
    to.surplus =
        m.give * c * v * (squareAt(m.p + v / Real(2)) - squareAt(m.p - v / Real(2))) / Real(8);
  }
  return to;
}

/// A damper of z, centred: it dissipates at any z.
template <class Real>
void brake(Real z, EnergyStableMotion<Real>& m) noexcept {
  const Real drag = Real(1) + m.give * z / Real(2);
  m.damper = -z * (m.opening + m.give * m.force) / (Real(2) * drag);
}

/// A contact with loss never pulls: where the damper would, it takes away what the elastic force
/// gives.
template <class Real>
void keepFromPulling(EnergyStableMotion<Real>& m, const EnergyStableState<Real>& state) noexcept {
  if (m.total() < Real(0)) {
    m.force = std::min(m.force, largestForce(state.tank, m.opening, Real(0)));
    m.damper = -m.force;
  }
}

/// The most that a damped contact which lasts for several steps can still hold as it lets go: what
/// it stored at the sample before, and what the motion of a step brings. While it was closed it may
/// have taken up more, as a finger does that glides along a bowed string; that given back within a
/// step would be a blow.
template <class Real>
Real mostLeft(const EnergyStableMotion<Real>& m,
              const EnergyStableLaw<Real>& law,
              const EnergyStableState<Real>& state) noexcept {
  // Where a place glides, the motion alone does not tell how deep it was.
  const Real last = std::max(state.p, m.p + std::abs(m.coasting) / Real(2));
  const bool was_closed = last > Real(0) && law.hasPush() && m.own_give > Real(0);
  if (!was_closed || !(law.damping > Real(0)) ||
      m.own_give * law.push(last).slope > Real(kShortContact)) {
    return std::numeric_limits<Real>::max();
  }
  return Real(2) * law.potential(last) + m.coasting * m.coasting / (Real(2) * m.own_give);
}

/// The link has let go: what is left in its tank goes back, once it opens, less what the law loses.
/// If something pushes it to again before that, it keeps the rest for the next contact.
template <class Real>
void release(EnergyStableMotion<Real>& m,
             const EnergyStableLaw<Real>& law,
             EnergyStableState<Real>& state) noexcept {
  lose(std::max(Real(0), state.tank - mostLeft(m, law, state)), state);
  m.empties = m.opening > Real(0);
  m.force = m.empties ? largestForce(state.tank, m.opening, m.give) : Real(0);
  if (law.form->is_lossy && state.phase == Real(0)) {
    brake(law.damping * m.force, m);
    keepFromPulling(m, state);
  }
  state.phase = Real(0);
}

template <class Real>
void exertElastic(EnergyStableMotion<Real>& m,
                  const EnergyStableLaw<Real>& law,
                  EnergyStableState<Real>& state) noexcept {
  const bool is_contact = law.isContact();
  const bool is_open = is_contact && !(m.p > Real(0));
  const bool has_push = law.hasPush();
  const EnergyStableForce<Real> at =
      is_open || !has_push ? EnergyStableForce<Real>{} : law.push(m.p);
  const Real kt = m.give * std::max(Real(0), at.slope);
  const Real deepest = m.p + std::abs(m.coasting) / Real(2);
  const bool is_long =
      is_contact && (!has_push || m.give * law.push(deepest).slope <= Real(kShortContact));
  if (is_open && !is_long) {
    return;
  }
  Real z = is_open ? Real(0) : law.dampingAt(m.p, -m.coasting / Real(2));
  const bool is_stiff = is_contact && z > Real(0) && m.own_give * at.slope > Real(1);
  const bool is_held = is_stiff && isHeld(m, at.slope);
  const bool is_impact = is_stiff && !is_held;
  const bool is_lossy = law.form->is_lossy && is_long && !is_impact;
  Real wanted = Real(0);
  if (is_lossy) {
    const Lossy<Real> lossy = wantedLossy(m, law, at, kt, z);
    wanted = lossy.wanted;
    z = lossy.z;
    lose(std::min(state.tank, lossy.surplus), state);
  } else {
    wanted = is_long && has_push ? wantedMean(m, law, at, kt) : wantedForce(m, at, kt, is_contact);
  }
  const Real damping = is_impact ? Real(0) : z;
  const Real drag = Real(1) + m.give * damping / Real(2);
  const Real budget = state.tank * drag;
  const auto e = [&](Real speed) {
    return law.form->restitution(law, z, at.slope, m.own_give, speed);
  };
  const Real high =
      is_impact ? rebound(m, e, wanted, state) : largestForce(budget, m.opening, m.give);
  const Real low = is_contact ? Real(0) : -largestForce(budget, -m.opening, m.give);
  m.force = std::clamp(wanted, low, high);
  if (is_held && wanted > high) {
    m.force = std::min(high, stoppingForce(m));  // or what is left would swing for ever
  }
  brake(damping, m);
  m.is_cut = wanted > high || (!is_contact && wanted < low);
  state.active += 1.0;
  if (law.form->is_lossy) {
    keepFromPulling(m, state);
  }
}

/// Two passes of Newton's method from the backward slip, each kept between no force and the force
/// that stops the slip.
template <class Real>
void exertFriction(EnergyStableMotion<Real>& m,
                   const EnergyStableLaw<Real>& law,
                   EnergyStableState<Real>& state) noexcept {
  const Real unbounded = std::copysign(std::numeric_limits<Real>::max(), -m.opening);
  const Real stop = m.give > Real(0) ? -m.opening / m.give : unbounded;
  const Real low = std::min(Real(0), stop);
  const Real high = std::max(Real(0), stop);
  Real slip = -m.coasting / Real(2);
  for (int pass = 0; pass < 2; ++pass) {
    const EnergyStableForce<Real> at = law.slip(slip);
    // Below that slope a centred step has more than one solution.
    const Real slope = m.give > Real(0) ? std::max(at.slope, Real(-1) / m.give) : at.slope;
    const Real wanted =
        (at.force - slope * (m.opening / Real(2) + slip)) / (Real(1) + slope * m.give / Real(2));
    m.damper = std::clamp(wanted, low, high);
    m.is_cut = std::abs(wanted) > std::abs(m.damper);
    slip = -m.swing() / Real(2);
  }
  state.active += m.damper != Real(0) ? 1.0 : 0.0;
}

}  // namespace

template <class Real>
bool holdsAt(Real p, const EnergyStableLaw<Real>& law, EnergyStableState<Real>& state) noexcept {
  const Real last = state.phase;
  state.phase = law.form->phase(law, p, last);
  if (last > Real(0) && state.phase == Real(0)) {
    lose(std::min(state.tank, law.form->snap(law)), state);
  }
  return state.phase > Real(0);
}

template <class Real>
void exertForce(EnergyStableMotion<Real>& m,
                const EnergyStableLaw<Real>& law,
                EnergyStableState<Real>& state) noexcept {
  if (m.is_friction) {
    exertFriction(m, law, state);
  } else if (m.is_pushing) {
    exertElastic(m, law, state);
  } else {
    release(m, law, state);
  }
}

template <class Real>
void payWork(EnergyStableMotion<Real>& m, EnergyStableState<Real>& state) noexcept {
  m.budget = state.tank;
  const Real swing = m.swing();
  const Real work = m.force * swing / Real(2);
  state.stored = static_cast<double>(state.tank - m.force * m.coasting / Real(4));
  m.heat = -m.damper * swing / Real(2);
  if (m.forfeits && work < Real(0)) {
    m.heat -= work;
  } else {
    state.tank -= work;
  }
  if (m.empties) {
    m.heat += state.tank;
    state.tank = Real(0);
  }
  state.force = m.force;
  state.damper = m.damper;
  state.foreseen = m.foreseen;
  state.p = m.p;
  std::copy_n(m.gradient, 3, state.gradient);
}

template <class Real>
void payArrears(Real moved, EnergyStableState<Real>& state) noexcept {
  const Real unforeseen = (moved - state.foreseen) / Real(2);
  state.lost -= static_cast<double>(state.damper * unforeseen);
  state.tank -= state.force * unforeseen;
  if (state.tank < Real(0)) {
    state.lost += static_cast<double>(state.tank);
    state.tank = Real(0);
  }
}

template bool holdsAt(float, const EnergyStableLaw<float>&, EnergyStableState<float>&) noexcept;
template bool holdsAt(double, const EnergyStableLaw<double>&, EnergyStableState<double>&) noexcept;
template void exertForce(EnergyStableMotion<float>&,
                         const EnergyStableLaw<float>&,
                         EnergyStableState<float>&) noexcept;
template void exertForce(EnergyStableMotion<double>&,
                         const EnergyStableLaw<double>&,
                         EnergyStableState<double>&) noexcept;
template void payWork(EnergyStableMotion<float>&, EnergyStableState<float>&) noexcept;
template void payWork(EnergyStableMotion<double>&, EnergyStableState<double>&) noexcept;
template void payArrears(float, EnergyStableState<float>&) noexcept;
template void payArrears(double, EnergyStableState<double>&) noexcept;

}  // namespace ergotic::physics
