// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "physics/layout/layout.hpp"

namespace ergotic::physics {

/// Decides which sections need each other at the same instant: they are stepped together, by one
/// thread. Sections that are stepped once per tick or more slowly are held, unless something needs
/// one of them at the same instant as a section that runs.
///
/// \param layout  with sections, places, runs and followers
/// \return [sections] the group that steps it, the expensive ones first, or LinkRun::kHeldGroup;
///         kHeldGroup also for a section without modules
/// Realtime: no
std::vector<int> partitionSections(const scene::Scene& scene,
                                   const Rates& rates,
                                   const Layout& layout);

/// Gives every run its group, and links from running to held sections proxies for their held ends.
/// \pre Layout::group_of_section is there. Realtime: no
void placeProxies(Layout& layout);

/// Finds the blocks of sections that run and never sleep, which no end of a link, point or input is
/// on, and outputs of nothing else reach. \pre proxies are placed. Realtime: no
void findLoneBlocks(const scene::Scene& scene, const Rates& rates, Layout& layout);

/// Steps of coordinates in a tick.
std::int64_t costOf(const SectionRange& range, const Rates& rates);

}  // namespace ergotic::physics
