// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ergotic/physics/engine/instrument.hpp"
#include "physics/engine/energy_stable.hpp"
#include "physics/engine/energy_stable_reach.hpp"
#include "physics/engine/near_links.hpp"
#include "physics/engine/points.hpp"
#include "physics/engine/pressures.hpp"
#include "physics/engine/stepper.hpp"
#include "physics/engine/tanks.hpp"
#include "physics/layout/energy_stable_groups.hpp"
#include "physics/layout/groups.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// The energy-stable links of an instrument: finds the modules behind their ends, steps those of
/// one rate together, and keeps their energy accounts.
template <class Real>
class EnergyStableRuns {
 public:
  /// Adds its entries to the arena. \pre the arena is not allocated
  EnergyStableRuns(const scene::Scene& scene,
                   const Layout& layout,
                   const Groups& groups,
                   const Points<Real>& points,
                   State<Real>& state);

  /// Steps the energy-stable links of a group whose steps end with frame `last`, adds their forces
  /// to modules and points. Only then are all other forces of these steps there: links to faster
  /// sections give theirs frame by frame. \pre so are those of the frames from `first` to `last`.
  /// Realtime: yes
  void step(const Group& group,
            std::int64_t first,
            std::int64_t last,
            const CoefficientsOf<Real>& c,
            const Stepper<Real>& stepper,
            State<Real>& state) noexcept;

  /// Tanks follow other coefficients. Realtime: yes
  void retune(const CoefficientsOf<Real>& from,
              const CoefficientsOf<Real>& to,
              State<Real>& state) noexcept;

  std::vector<TankReport> makeReports() const;
  /// Realtime: yes
  void read(const State<Real>& state, std::vector<TankReport>& to) const noexcept;
  /// True if every energy that a link may spend is a finite number. Realtime: yes
  bool isFinite(const State<Real>& state) const noexcept;

 private:
  /// A link with ends on places, and where these were when its modules were found.
  struct OnPlaces {
    std::size_t link = 0;
    std::array<int, 2> places{-1, -1};
    std::array<double, 4> found_at{};
  };
  /// Links of one rate in one group.
  struct Links {
    EnergyStableLinks<Real> links;
    NearLinks<Real> near;
    std::vector<OnPlaces> on_places;
    std::vector<std::vector<std::size_t>> taps;  // [links] that each reaches as a module
    std::vector<unsigned char> idle;             // [links]
    std::vector<int> slow;                       // sections that are stepped more slowly
    std::vector<unsigned char> due;  // [sections] of these, that moved as the present step began
    std::size_t states_at;
    std::size_t clearances_at;
    EnergyStableReach::Terms terms;  // of one of those on places
  };

  void addLinks(const scene::Scene& scene, const EnergyStableGroup& members, State<Real>& state);
  bool mayWait(const scene::Scene& scene, const EnergyStableRef& ref) const;
  /// True if the step of these links ends with that frame.
  bool endsStep(std::size_t g, std::int64_t frame) const noexcept {
    return (frame + 1) % members_[g].divisor == 0;
  }
  void lookAhead(std::size_t g, const CoefficientsOf<Real>& c, const State<Real>& state) noexcept;
  std::vector<int> reachedBy(const Group& group) const;
  EnergyStableView<Real> viewOf(const Links& links,
                                const CoefficientsOf<Real>& c,
                                State<Real>& state) const noexcept;
  void followPlaces(std::size_t g, State<Real>& state) noexcept;
  void markIdle(std::size_t g, State<Real>& state) noexcept;
  void markDue(std::size_t g, std::int64_t began) noexcept;
  void exchange(std::size_t g,
                std::int64_t began,
                const Stepper<Real>& stepper,
                State<Real>& state) noexcept;
  bool remembersForce(const EnergyStableRef& ref, const State<Real>& state) const noexcept;
  void rememberGaps(std::size_t g, State<Real>& state) noexcept;
  void closeAccounts(std::size_t g, bool starts, State<Real>& state) const noexcept;
  EnergyStableState<Real>* states(std::size_t g, State<Real>& state) const noexcept {
    return state.arena().template at<EnergyStableState<Real>>(links_[g].states_at);
  }
  Real* clearances(std::size_t g, State<Real>& state) const noexcept {
    return state.arena().template at<Real>(links_[g].clearances_at);
  }

  const Layout& layout_;
  const Points<Real>& points_;
  std::vector<Real> ahead_;                 // [slots] how far taps will go
  std::vector<EnergyStableGroup> members_;  // energyStableGroupsOf
  EnergyStableReach reach_;
  Pressures<Real> pressures_;
  std::vector<EnergyStableModule<Real>> modules_;  // [slots]
  std::vector<Links> links_;                       // [members_]
  Tanks<Real> tanks_;
  std::vector<Real> forces_;               // [slots], of energy-stable links; zero between steps
  std::vector<std::vector<int>> reached_;  // [members_] slots that those of its group can be on
};

extern template class EnergyStableRuns<float>;
extern template class EnergyStableRuns<double>;

}  // namespace ergotic::physics
