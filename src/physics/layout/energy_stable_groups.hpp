// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "physics/layout/layout.hpp"

namespace ergotic::physics {

struct EnergyStableRef {
  std::size_t run = 0;  ///< index in Layout::runs
  std::size_t link = 0;
};

/// Energy-stable links that are stepped together. Those of one run follow one another.
struct EnergyStableGroup {
  int divisor = 1;                     ///< audio frames per step
  int group = LinkRun::kHeldGroup;     ///< LinkRun::group
  std::vector<EnergyStableRef> links;  // but those that share a tank
  std::vector<std::size_t> tanks;      // runs of these
};

/// Lists all energy-stable links of a layout, by group and rate. Realtime: no.
inline std::vector<EnergyStableGroup> energyStableGroupsOf(const Layout& layout) {
  std::vector<EnergyStableGroup> groups;
  for (std::size_t r = 0; r < layout.runs.size(); ++r) {
    const LinkRun& run = layout.runs[r];
    if (!run.energy_stable) {
      continue;
    }
    const int divisor = layout.sections[static_cast<std::size_t>(run.section)].divisor;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const EnergyStableGroup& g) {
      return g.divisor == divisor && g.group == run.group;
    });
    if (group == groups.end()) {
      group = groups.insert(groups.end(), {divisor, run.group, {}, {}});
    }
    if (run.tank >= 0) {
      group->tanks.push_back(r);
      continue;
    }
    for (std::size_t l = 0; l < run.ends.size(); ++l) {
      group->links.push_back({r, l});
    }
  }
  return groups;
}

}  // namespace ergotic::physics
