// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "physics/layout/layout.hpp"

namespace ergotic::physics {

/// A block that nothing but its own links acts on while it runs (Block::is_alone), and what is
/// heard of it.
struct LoneBlock {
  std::size_t block = 0;                    ///< Layout::blocks
  std::vector<std::size_t> pickups;         ///< Layout::pickups
  std::vector<std::size_t> pickup_columns;  ///< [pickups] index in Group::channels
};

/// Parts that need each other at the same instant, as indices: one thread steps them.
struct Group {
  std::vector<int> sections;                ///< Layout::sections
  std::vector<std::size_t> runs;            ///< Layout::runs, explicit ones
  std::vector<std::size_t> energy_stable;   ///< energyStableGroupsOf
  std::vector<std::size_t> taps;            ///< Layout::taps
  std::vector<std::size_t> places;          ///< Layout::places
  std::vector<std::size_t> interpolated;    ///< Layout::interpolated, seen by its sections
  std::vector<std::size_t> answered;        ///< Layout::interpolated, of slices of its sections
  std::vector<std::size_t> projections;     ///< Layout::projections
  std::vector<std::size_t> feeds;           ///< Layout::feeds
  std::vector<std::size_t> followers;       ///< Layout::followers
  std::vector<std::size_t> pickups;         ///< Layout::pickups
  std::vector<int> channels;                ///< output channels that the pickups feed, each once
  std::vector<std::size_t> pickup_columns;  ///< [pickups] index in `channels`
  std::vector<LoneBlock> lone;
  bool has_only_lone = false;  ///< there is nothing to do frame by frame
  std::vector<Proxy> proxies;
  std::int64_t modules = 0;
  std::int64_t cost = 0;  ///< steps of coordinates in a tick
};

/// The order inside a tick: held sections move, groups are stepped through all frames of the tick,
/// the forces on held sections are summed. Which are which: partitionSections.
struct Groups {
  Group held;
  std::vector<Group> running;  ///< the expensive ones first
};

/// Makes one group of all sections, feeds and points. Realtime: no
Group everythingOf(const Layout& layout);

/// Describes what is stepped together, one line per group. Realtime: no
std::vector<std::string> describeGroups(const scene::Scene& scene,
                                        const Groups& groups,
                                        int threads);

/// Deals everything of a layout out to the groups of its sections. Realtime: no
Groups makeGroups(const scene::Scene& scene, const Rates& rates, const Layout& layout);

}  // namespace ergotic::physics
