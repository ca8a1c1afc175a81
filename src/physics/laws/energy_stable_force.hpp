// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "scene/laws/energy_stable_form.hpp"

namespace ergotic::physics {

using scene::EnergyStableForce;
using scene::EnergyStableLaw;

/// State that an energy-stable link keeps between steps; all 0 before it starts. Energies in force
/// unit times m. Letters are those of docs/physics/schemes.md, "Energy-stable links".
template <class Real>
struct EnergyStableState {
  double stored = 0.0;      ///< at this step: the tank, with the first half of the step's work
  double lost = 0.0;        ///< energy dissipated since the start
  double active = 0.0;      ///< number of steps in which it pushed
  double clipped = 0.0;     ///< number of active steps with less force than its law asks for
  Real tank = Real(0);      ///< E, energy it may still give
  Real force = Real(0);     ///< F of the last step, elastic
  Real damper = Real(0);    ///< of the last step, damping or friction
  Real foreseen = Real(0);  ///< how far what forces do not move was to open it
  Real p = Real(0);         ///< compression or elongation at the last step, m
  Real gradient[3] = {Real(0), Real(0), Real(0)};  ///< of the last step
  /// 1 once an impact has turned around, or while what may stick slips; of what lets go as its law
  /// says.
  Real phase = Real(0);

  static constexpr std::size_t kDoubles = sizeof(Real) == sizeof(double) ? 13 : 4;
};

/// Inputs and results of an energy-stable link in one step. The link opens while p falls. Letters
/// as above.
template <class Real>
struct EnergyStableMotion {
  Real p = Real(0);                                ///< p, compression or elongation, m
  Real gradient[3] = {Real(0), Real(0), Real(0)};  ///< of p over end a less end b
  Real coasting = Real(0);  ///< sk, how far it would open over two steps at its present velocity, m
  Real opening = Real(0);   ///< s0, the same with the forces of all others
  Real expected =
      Real(0);  ///< part of that: what the other energy-stable links on its masses will do
  Real foreseen = Real(0);  ///< part of that in the step to come, by what forces do not move
  Real give = Real(0);      ///< q, opening per force if all on its masses change theirs alike
  Real own_give = Real(0);  ///< q with c = 1: if it were alone
  Real force = Real(0);     ///< F, elastic, closed links push: > 0
  Real damper = Real(0);    ///< -z (s0 + q F)/d, or friction
  Real budget = Real(0);    ///< energy that the tank held before the work of this step
  Real heat = Real(0);      ///< work of the damper in this step, turned into heat
  bool is_friction = false;
  bool is_pushing = false;  ///< contact is closed, or the link is two-sided
  bool is_active = false;   ///< may have a force
  bool is_shared = false;   ///< others are active on its masses
  bool is_cut = false;      ///< has less force than its law asks for
  bool empties = false;     ///< its tank is void after this step
  bool forfeits = false;    ///< energy that it absorbs in this step is lost

  Real total() const noexcept { return force + damper; }
  /// s0 + q (F + damper), how far it opens over two steps, as far as is expected.
  Real swing() const noexcept { return opening + give * total(); }
};

/// The largest force whose work F (opening + give F) / 2 is at most `energy`. Realtime: yes
template <class Real>
Real largestForce(Real energy, Real opening, Real give) noexcept {
  const Real root = std::sqrt(opening * opening + Real(8) * give * energy);
  if (opening > Real(0)) {
    return Real(4) * energy / (opening + root);  // without cancellation, and for give = 0
  }
  return give > Real(0) ? (root - opening) / (Real(2) * give) : std::numeric_limits<Real>::max();
}

/// Whether a spring that lets go holds at p; it loses what its law does. Realtime: yes
template <class Real>
bool holdsAt(Real p, const EnergyStableLaw<Real>& law, EnergyStableState<Real>& state) noexcept;

/// Works out force and damper. \pre all that is above them in `m` is known
/// Realtime: yes. Source: docs/physics/schemes.md, "Energy-stable links".
template <class Real>
void exertForce(EnergyStableMotion<Real>& m,
                const EnergyStableLaw<Real>& law,
                EnergyStableState<Real>& state) noexcept;

/// Pays the work of this step from the tank, as the motion is expected. Realtime: yes
template <class Real>
void payWork(EnergyStableMotion<Real>& m, EnergyStableState<Real>& state) noexcept;

/// Takes back what it was charged too much: `swing` is how far it opened more than it really will.
/// Realtime: yes
template <class Real>
void takeBack(Real swing, EnergyStableMotion<Real>& m, EnergyStableState<Real>& state) noexcept {
  state.tank += m.force * swing / Real(2);
  m.heat += m.damper * swing / Real(2);
}

/// Ends the step: neither tank nor heat stays below 0, each pays for the other. Realtime: yes
template <class Real>
void closeStep(const EnergyStableMotion<Real>& m, EnergyStableState<Real>& state) noexcept {
  state.clipped += m.is_cut ? 1.0 : 0.0;
  const Real both = state.tank + m.heat;
  state.tank = std::clamp(state.tank, Real(0), std::max(Real(0), both));
  state.lost += static_cast<double>(both - state.tank);
}

/// Pays what the force of the last step did beyond what was foreseen then.
/// \param moved  how far what forces do not move has opened the link since. Realtime: yes
template <class Real>
void payArrears(Real moved, EnergyStableState<Real>& state) noexcept;

}  // namespace ergotic::physics
