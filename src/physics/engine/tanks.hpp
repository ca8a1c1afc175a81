// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ergotic/physics/engine/instrument.hpp"
#include "physics/layout/energy_stable_groups.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// State of all links that share a tank, between two steps. Energies in force unit times m.
struct TankState {
  double stored = 0.0;   ///< at this step: what the tank holds, with the first half of its work
  double active = 0.0;   ///< steps in which it pushed
  double clipped = 0.0;  ///< of these, steps with less force than its potential asks for, by more
                         ///< than rounding takes from it
  double most = 0.0;     ///< the most that it has held: of that a part is lost by rounding

  static constexpr std::size_t kDoubles = 4;  ///< see numbersOf
};

/// Steps that were counted. A state that was loaded may say anything. Realtime: yes
inline std::int64_t wholeOf(double steps) noexcept {
  return steps >= 0.0 && steps <= 1e18 ? static_cast<std::int64_t>(steps) : 0;
}

/// Hardening links with one energy tank for all of a body: its potential is V = psi^2/2, its force
/// -psi grad psi, with the mean of psi over the steps before and after. That is one equation, and
/// linear, as psi changes by grad psi times the way of the modules. So the tank never gives more
/// than it took, at the cost of explicit links. Source: docs/physics/bodies.md, "One energy tank
/// for a body".
template <class Real>
class Tanks {
 public:
  /// Adds its entries to the arena. \pre the arena is not allocated
  Tanks(const Layout& layout, const std::vector<EnergyStableGroup>& groups, State<Real>& state);

  /// Fills the tanks of a group, in the first frame. Realtime: yes
  void start(std::size_t group, const CoefficientsOf<Real>& c, State<Real>& state) noexcept;

  /// Adds the forces of those of a group (of `groups`) to the modules.
  /// \pre all forces but those of energy-stable links are there. Realtime: yes. Cost: O(links +
  /// modules)
  void exert(std::size_t group, const CoefficientsOf<Real>& c, State<Real>& state) noexcept;

  /// Answers what energy-stable links have added to the modules since. Realtime: yes
  void answer(std::size_t group, const CoefficientsOf<Real>& c, State<Real>& state) noexcept;

  /// Tanks follow other coefficients. Realtime: yes
  void retune(const CoefficientsOf<Real>& from,
              const CoefficientsOf<Real>& to,
              State<Real>& state) noexcept;

  /// True if what all of them hold is a finite number. Realtime: yes
  bool areFinite(const State<Real>& state) const noexcept;
  /// Adds one report for each tank, which names its first link. Realtime: no
  void addReports(std::vector<TankReport>& to) const;
  /// \param to  the first of these. Realtime: yes
  void read(const State<Real>& state, TankReport* to) const noexcept;

 private:
  struct Body {
    std::size_t run = 0;
    int first = 0;  ///< slot, of all between its modules
    int count = 0;
    std::vector<std::uint32_t> modules;  ///< slots less `first`: others may lie between them
    bool is_lone = false;                ///< no other energy-stable link is in its group
    std::size_t state_at = 0;
    std::size_t force_at = 0;  ///< [count] of the last step, opposite to what modules feel
    std::vector<Real> slope;   ///< [count] of the sum of the links over the modules
    double per_slope = 0.0;    ///< grad psi = per_slope slope
    double half = 0.0;         ///< half the change of psi in the step just made
    double mean = 0.0;         ///< mean of psi over that step and the step to come
    double give = 0.0;         ///< h^2 (grad psi)' M^-1 (grad psi)/4
    double push = 0.0;         ///< slope times the step to come by the other forces
  };

  void measure(Body& body, const RunCoefficients<Real>& c, const Real* x, double& psi) noexcept;
  void addForce(Body& body, double psi, State<Real>& state) const noexcept;
  TankState& stateOf(const Body& body, State<Real>& state) const noexcept {
    return *state.arena().template at<TankState>(body.state_at);
  }

  const Layout& layout_;
  std::vector<std::vector<Body>> bodies_;  // [groups]
};

extern template class Tanks<float>;
extern template class Tanks<double>;

}  // namespace ergotic::physics
