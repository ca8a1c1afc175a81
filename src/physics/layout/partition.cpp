// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/partition.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"

namespace ergotic::physics {
namespace {

constexpr int kSlotsPerLine = 16;  // groups must not share a cache line

/// Sections that need each other at the same instant.
class Split {
 public:
  Split(const scene::Scene& scene, const Rates& rates, const Layout& layout)
      : scene_(scene), layout_(layout), sets_(layout.sections.size()) {
    for (const SectionRange& range : layout.sections) {
      held_.push_back(rates.ratio > 1 && range.divisor >= rates.ratio);
    }
    while (releaseOne()) {
    }
    joinAll();
  }

  bool isHeld(int section) const { return held_[at(section)]; }
  /// The section that represents all sections of its group.
  int leaderOf(int section) { return sets_.setOf(section); }

 private:
  /// Sections of the guides that a point has.
  std::vector<int> sectionsOfGuides(const PlacePoint& point) const {
    const scene::Connection& connection = scene_.connections[at(point.connection)];
    std::vector<int> sections;
    for (const scene::Connection::Way& way : {connection.along, connection.across}) {
      if (way.guide >= 0) {
        sections.push_back(scene_.mats[at(way.guide)].section);
      }
    }
    return sections;
  }

  /// A held section that a running one needs in the middle of a tick runs too.
  bool releaseOne() {
    const auto release = [this](int section) {
      held_[at(section)] = false;
      return true;
    };
    for (const PlacePoint& point : layout_.places) {
      for (const int guide : sectionsOfGuides(point)) {
        if (isHeld(point.section) && !isHeld(guide)) {
          return release(point.section);
        }
      }
    }
    for (const LinkRun& run : layout_.runs) {
      if (!run.energy_stable || run.interpolated ||
          isHeld(run.section_a) == isHeld(run.section_b)) {
        continue;
      }
      // An energy-stable link foresees the step of both of its ends, but that of a slower one.
      const int held = isHeld(run.section_a) ? run.section_a : run.section_b;
      if (held != run.slow_section) {
        return release(held);
      }
    }
    return false;
  }

  void join(int a, int b) {
    if (!isHeld(a) && !isHeld(b)) {
      const int one = leaderOf(a);
      const int other = leaderOf(b);
      sets_.join(std::max(one, other), std::min(one, other));
    }
  }

  void joinAll() {
    for (const LinkRun& run : layout_.runs) {
      join(run.section_a, run.section_b);
    }
    for (const Pressing& pressing : layout_.pressings) {
      const LinkRun& by = layout_.runs[pressing.by_run];
      join(layout_.runs[pressing.run].section, isHeld(by.section_a) ? by.section_b : by.section_a);
    }
    for (const PlacePoint& point : layout_.places) {
      for (const int guide : sectionsOfGuides(point)) {
        join(point.section, guide);
      }
    }
    for (const scene::Output& output : scene_.outputs) {
      if (output.point.next >= 0) {
        join(scene_.mats[at(output.point.mat)].section, scene_.mats[at(output.point.next)].section);
      }
    }
    // Coefficients that follow audio inputs all read the one place where the samples are.
    const auto running = [this](const Follower& f) { return !isHeld(f.section); };
    const auto first = std::find_if(layout_.followers.begin(), layout_.followers.end(), running);
    for (const Follower& follower : layout_.followers) {
      if (running(follower)) {
        join(first->section, follower.section);
      }
    }
  }

  const scene::Scene& scene_;
  const Layout& layout_;
  std::vector<bool> held_;
  DisjointSets sets_;  // of sections
};

/// Slots of their own for what the groups see of held modules.
class ProxyPlacer {
 public:
  explicit ProxyPlacer(Layout& layout) : layout_(layout) {}

  /// \param runs  from running sections of this group to held ones
  void place(const std::vector<LinkRun*>& runs, std::vector<Proxy>& proxies) {
    pad();
    std::map<std::pair<int, int>, int> known;  // slot and coordinates of a held end: its proxy
    for (LinkRun* run : runs) {
      const bool held_is_a = layout_.group_of_section[at(run->section_a)] == LinkRun::kHeldGroup;
      int& stride = held_is_a ? run->stride_a : run->stride_b;
      const int dimensions = std::max(1, run->dimensions);
      for (LinkEnds& ends : run->ends) {
        int& end = held_is_a ? ends.a : ends.b;
        const auto [proxy, is_new] = known.try_emplace({end, dimensions}, layout_.slots());
        for (int k = 0; k < dimensions && is_new; ++k) {
          proxies.push_back({addSlot(k), end + k * stride});
        }
        end = proxy->second;
      }
      stride = run->dimensions == 0 ? 0 : 1;
    }
    pad();
  }

 private:
  int addSlot(int component) {
    layout_.mat_of_slot.push_back(-1);
    layout_.component.push_back(component);
    return layout_.slots() - 1;
  }
  void pad() {
    while (layout_.slots() % kSlotsPerLine != 0) {
      addSlot(0);
    }
  }

  Layout& layout_;
};

}  // namespace

std::int64_t costOf(const SectionRange& range, const Rates& rates) {
  return static_cast<std::int64_t>(range.stride) * range.dimensions *
         std::max(1, rates.ratio / range.divisor);
}

std::vector<int> partitionSections(const scene::Scene& scene,
                                   const Rates& rates,
                                   const Layout& layout) {
  struct Members {
    std::vector<int> sections;
    std::int64_t cost = 0;
  };
  Split split(scene, rates, layout);
  std::map<int, Members> by_leader;
  for (int s = 0; s < static_cast<int>(layout.sections.size()); ++s) {
    const SectionRange& range = layout.sections[at(s)];
    if (range.stride > 0 && !split.isHeld(s)) {
      Members& members = by_leader[split.leaderOf(s)];
      members.sections.push_back(s);
      members.cost += costOf(range, rates);
    }
  }
  std::vector<Members> running;
  for (auto& [leader, members] : by_leader) {
    running.push_back(std::move(members));
  }
  std::stable_sort(running.begin(), running.end(),
                   [](const Members& a, const Members& b) { return a.cost > b.cost; });
  std::vector<int> group_of_section(layout.sections.size(), LinkRun::kHeldGroup);
  for (std::size_t g = 0; g < running.size(); ++g) {
    for (const int s : running[g].sections) {
      group_of_section[at(s)] = static_cast<int>(g);
    }
  }
  return group_of_section;
}

void placeProxies(Layout& layout) {
  int groups = 0;
  for (const int group : layout.group_of_section) {
    groups = std::max(groups, group + 1);
  }
  std::vector<std::vector<LinkRun*>> to_held(at(groups));
  for (LinkRun& run : layout.runs) {
    const int a = layout.group_of_section[at(run.section_a)];
    const int b = layout.group_of_section[at(run.section_b)];
    run.group = std::max(a, b);  // running before held
    if (a != b && !run.interpolated) {
      to_held[at(run.group)].push_back(&run);
    }
  }
  layout.proxies.resize(at(groups));
  for (std::size_t g = 0; g < to_held.size(); ++g) {
    if (!to_held[g].empty()) {
      ProxyPlacer(layout).place(to_held[g], layout.proxies[g]);
    }
  }
}

void findLoneBlocks(const scene::Scene& scene, const Rates& rates, Layout& layout) {
  std::vector<bool> touched(layout.blocks.size(), false);
  const auto touch = [&](int slot) {
    const int block = slot < 0 ? -1 : layout.blockOf(slot);
    if (block >= 0) {
      touched[at(block)] = true;
    }
  };
  for (const LinkRun& run : layout.runs) {
    for (const LinkEnds& ends : run.ends) {
      if (run.block < 0) {
        touch(ends.a);
        touch(ends.b);
      }
    }
  }
  for (const TapPoint& tap : layout.taps) {
    forEachShare(tap, [&](int slot, double) { touch(slot); });
  }
  for (const PlacePoint& point : layout.places) {
    for (const int guide : point.guides) {
      touch(guide);
    }
    const scene::Grid& grid = scene.grids[at(scene.connections[at(point.connection)].grid)];
    for (int m = grid.first; m < grid.first + grid.columns * grid.rows; ++m) {
      touch(layout.slot_of_mat[at(m)]);
    }
  }
  for (const ProjectedPoint& point : layout.projections) {
    touch(point.of.slot);
  }
  for (const Feed& feed : layout.feeds) {
    touch(feed.slot);
  }
  for (const Pickup& pickup : layout.pickups) {
    if (pickup.next >= 0 && layout.blockOf(pickup.slot) != layout.blockOf(pickup.next)) {
      touch(pickup.slot);
      touch(pickup.next);
    }
  }
  for (std::size_t b = 0; b < touched.size(); ++b) {
    Block& block = layout.blocks[b];
    block.is_alone = !touched[b] &&
                     layout.group_of_section[at(block.section)] != LinkRun::kHeldGroup &&
                     rates.ratio % layout.sections[at(block.section)].divisor == 0 &&
                     scene.sections[at(block.section)].sleep_energy == 0.0;
  }
}

}  // namespace ergotic::physics
