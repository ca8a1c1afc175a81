// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "physics/engine/energy_stable.hpp"
#include "physics/layout/energy_stable_groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Normal forces of the dry frictions of an instrument: numbers, or the last forces of contacts. A
/// contact belongs to the group of the friction, or to held sections, which do not move while it
/// runs.
template <class Real>
class Pressures {
 public:
  Pressures(const Layout& layout, const std::vector<EnergyStableGroup>& groups);

  /// Reads the normal forces of the energy-stable links of a group.
  /// \param laws  [links] of it. Realtime: yes
  const Pressure<Real>* read(std::size_t group,
                             const EnergyStableLaw<Real>* laws,
                             State<Real>& state) noexcept;

 private:
  /// A dry friction, by its index in its group.
  struct Friction {
    std::size_t link = 0;
    int pressing = -1;  ///< index in Layout::pressings, -1: a number presses it
  };
  void readContact(const Pressing& by, State<Real>& state, Pressure<Real>& to) const noexcept;

  const Layout& layout_;
  std::vector<std::vector<Friction>> frictions_;      // [groups]
  std::vector<std::vector<Pressure<Real>>> pressed_;  // [groups][links]
};

extern template class Pressures<float>;
extern template class Pressures<double>;

}  // namespace ergotic::physics
