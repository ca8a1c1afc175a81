// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "physics/engine/energy_stable.hpp"
#include "physics/layout/energy_stable_groups.hpp"
#include "physics/layout/layout.hpp"

namespace ergotic::physics {

/// The modules behind the ends of energy-stable links, through points and other frames. A tap
/// counts as one module where what energy-stable links do to it moves nothing else that they act
/// on, as places on a body with all its modes; else the links reach the modules under it, where
/// they know of each other.
class EnergyStableReach {
 public:
  struct Terms {
    std::vector<EnergyStableTerm> terms;
    double offset[3] = {0.0, 0.0, 0.0};
  };

  EnergyStableReach(const scene::Scene& scene,
                    const Layout& layout,
                    const std::vector<EnergyStableGroup>& groups);

  /// Finds the terms of a link. Their number does not depend on the positions of points; `to` has
  /// room for them if they were found before.
  /// Realtime: then
  void find(const EnergyStableRef& ref, const double* places, Terms& to) const noexcept;

  /// Places, which may move, that the ends lie on; -1: an end lies on none.
  std::array<int, 2> placesOf(const EnergyStableRef& ref) const noexcept;
  bool isOnPlace(const EnergyStableRef& ref) const noexcept {
    const std::array<int, 2> places = placesOf(ref);
    return places[0] >= 0 || places[1] >= 0;
  }
  /// True if an end lies on a place that may move, or stands for one that is held in another group.
  /// Realtime: no
  bool mayBeLed(const EnergyStableRef& ref) const;
  /// Taps among the ends that count as one module. Realtime: no
  std::vector<std::size_t> tapsAt(const EnergyStableRef& ref) const;
  /// Slots of all modules that a place can come to. Realtime: no
  std::vector<int> slotsUnder(std::size_t place) const;

 private:
  /// Slot of the module or point that an end represents behind all projections.
  int behind(int slot) const noexcept;
  void findWholeTaps(const scene::Scene& scene, const std::vector<EnergyStableGroup>& groups);
  void reachEnd(int slot,
                int stride,
                int dimensions,
                const Eigen::Matrix3d& map,
                int slow_section,
                const double* places,
                Terms& to) const noexcept;

  const Layout& layout_;
  std::vector<scene::Grid> grids_;       // [places]
  std::vector<Eigen::Vector3d> rests_;   // [mats]
  std::vector<int> place_of_slot_;       // -1: none
  std::vector<int> projection_of_slot_;  // -1: none
  std::vector<int> tap_of_slot_;         // -1: none
  std::vector<unsigned char> is_whole_;  // [taps] 1: counts as one module
};

}  // namespace ergotic::physics
