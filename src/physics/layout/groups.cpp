// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/groups.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "physics/disjoint_sets.hpp"
#include "physics/layout/guarded_groups.hpp"

namespace ergotic::physics {
namespace {

constexpr int kSlotsPerLine = 16;  // groups must not share a cache line

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

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
  /// One section that stands for all of its group.
  int leaderOf(int section) { return sets_.setOf(section); }

 private:
  int sectionOfGuide(const PlacePoint& point) const {
    const int guide = scene_.connections[at(point.connection)].guide;
    return guide < 0 ? -1 : scene_.mats[at(guide)].section;
  }

  /// A held section that a running one needs in the middle of a tick runs too.
  bool releaseOne() {
    const auto release = [this](int section) {
      held_[at(section)] = false;
      return true;
    };
    for (const PlacePoint& point : layout_.places) {
      const int guide = sectionOfGuide(point);
      if (guide >= 0 && isHeld(point.section) && !isHeld(guide)) {
        return release(point.section);
      }
    }
    for (const LinkRun& run : layout_.runs) {
      if (!run.guarded || isHeld(run.section_a) == isHeld(run.section_b)) {
        continue;
      }
      // A guarded link foresees the step of both of its ends, but that of a slower one.
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
    for (const PlacePoint& point : layout_.places) {
      if (sectionOfGuide(point) >= 0) {
        join(point.section, sectionOfGuide(point));
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

/// Deals everything out to the groups of its sections.
class Dealer {
 public:
  Dealer(const scene::Scene& scene, const Rates& rates, Layout& layout)
      : scene_(scene),
        layout_(layout),
        ratio_(rates.ratio),
        group_of_section_(layout.sections.size(), kHeld) {
    makeGroups(Split(scene, rates, layout), rates);
  }

  Groups deal() {
    dealRuns();
    dealBySection(layout_.modal_places, &Group::modal_places,
                  [](const auto& p) { return p.section; });
    dealBySection(layout_.places, &Group::places, [](const auto& p) { return p.section; });
    dealBySection(layout_.projections, &Group::projections,
                  [](const auto& p) { return p.of.section; });
    dealBySection(layout_.feeds, &Group::feeds, [](const auto& f) { return f.section; });
    dealBySection(layout_.followers, &Group::followers, [](const auto& f) { return f.section; });
    dealLoneBlocks();
    for (std::size_t k = 0; k < layout_.taps.size(); ++k) {
      dealTap(k, groupOf(scene_.mats[at(scene_.outputs[k].point.mat)].section));
    }
    const std::vector<GuardedGroup> guarded = guardedGroupsOf(layout_);
    for (std::size_t g = 0; g < guarded.size(); ++g) {
      byIndex(guarded[g].group).guarded.push_back(g);
    }
    for (Group& group : groups_.running) {
      group.has_only_lone = hasOnlyLone(group);
    }
    return std::move(groups_);
  }

 private:
  bool hasOnlyLone(const Group& group) const {
    const bool has_modules =
        std::any_of(group.sections.begin(), group.sections.end(), [this](int s) {
          const SectionRange& range = layout_.sections[at(s)];
          return range.end > range.cells || range.dimensions > 1 || range.first == range.cells;
        });
    std::size_t blocks = 0;
    for (const Block& block : layout_.blocks) {
      blocks += std::count(group.sections.begin(), group.sections.end(), block.section) > 0 ? 1 : 0;
    }
    return !has_modules && blocks == group.lone.size() && group.runs.empty() &&
           group.guarded.empty() && group.places.empty() && group.projections.empty() &&
           group.feeds.empty() && group.followers.empty() && group.taps.empty() &&
           group.proxies.empty();
  }

  static constexpr int kHeld = LinkRun::kHeldGroup;

  void makeGroups(Split split, const Rates& rates) {
    std::map<int, Group> by_leader;
    for (int s = 0; s < static_cast<int>(layout_.sections.size()); ++s) {
      const SectionRange& range = layout_.sections[at(s)];
      if (range.stride == 0) {
        continue;  // no modules
      }
      Group& group = split.isHeld(s) ? groups_.held : by_leader[split.leaderOf(s)];
      group.sections.push_back(s);
      group.modules += range.stride;
      group.cost += static_cast<std::int64_t>(range.stride) * range.dimensions *
                    std::max(1, rates.ratio / range.divisor);
    }
    for (auto& [leader, group] : by_leader) {
      groups_.running.push_back(std::move(group));
    }
    std::stable_sort(groups_.running.begin(), groups_.running.end(),
                     [](const Group& a, const Group& b) { return a.cost > b.cost; });
    for (std::size_t g = 0; g < groups_.running.size(); ++g) {
      for (const int s : groups_.running[g].sections) {
        group_of_section_[at(s)] = static_cast<int>(g);
      }
    }
  }

  Group& byIndex(int g) { return g == kHeld ? groups_.held : groups_.running[at(g)]; }
  Group& groupOf(int section) { return byIndex(group_of_section_[at(section)]); }

  template <class Item, class SectionOf>
  void dealBySection(const std::vector<Item>& items,
                     std::vector<std::size_t> Group::*to,
                     const SectionOf& section_of) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      (groupOf(section_of(items[i])).*to).push_back(i);
    }
  }

  /// Blocks of sections that run and never sleep, which no end of a link, point or input is on.
  void dealLoneBlocks() {
    std::vector<bool> touched(layout_.blocks.size(), false);
    const auto touch = [&](int slot) {
      const int block = slot < 0 ? -1 : layout_.blockOf(slot);
      if (block >= 0) {
        touched[at(block)] = true;
      }
    };
    for (const LinkRun& run : layout_.runs) {
      for (const LinkEnds& ends : run.ends) {
        if (run.block < 0) {
          touch(ends.a);
          touch(ends.b);
        }
      }
    }
    for (const PlacePoint& point : layout_.places) {
      touch(point.guide);
      const scene::Grid& grid = scene_.grids[at(scene_.connections[at(point.connection)].grid)];
      for (int m = grid.first; m < grid.first + grid.columns * grid.rows; ++m) {
        touch(layout_.slot_of_mat[at(m)]);
      }
    }
    for (const ProjectedPoint& point : layout_.projections) {
      touch(point.of.slot);
    }
    for (const Feed& feed : layout_.feeds) {
      touch(feed.slot);
    }
    for (const Tap& tap : layout_.taps) {
      if (tap.next >= 0 && layout_.blockOf(tap.slot) != layout_.blockOf(tap.next)) {
        touch(tap.slot);
        touch(tap.next);
      }
    }
    for (std::size_t b = 0; b < touched.size(); ++b) {
      Block& block = layout_.blocks[b];
      block.is_alone = !touched[b] && group_of_section_[at(block.section)] != kHeld &&
                       ratio_ % layout_.sections[at(block.section)].divisor == 0 &&
                       scene_.sections[at(block.section)].sleep_energy == 0.0;
      if (block.is_alone) {
        groupOf(block.section).lone.push_back({b, {}, {}});
      }
    }
  }

  void dealTap(std::size_t k, Group& group) {
    const int channel = layout_.taps[k].channel;
    const auto known = std::find(group.channels.begin(), group.channels.end(), channel);
    const int block = layout_.blockOf(layout_.taps[k].slot);
    const auto lone = std::find_if(group.lone.begin(), group.lone.end(), [&](const LoneBlock& l) {
      return static_cast<int>(l.block) == block;
    });
    auto& taps = lone == group.lone.end() ? group.taps : lone->taps;
    auto& columns = lone == group.lone.end() ? group.tap_columns : lone->tap_columns;
    taps.push_back(k);
    columns.push_back(static_cast<std::size_t>(known - group.channels.begin()));
    if (known == group.channels.end()) {
      group.channels.push_back(channel);
    }
  }

  void dealRuns() {
    std::vector<std::vector<std::size_t>> to_held(groups_.running.size());
    for (std::size_t r = 0; r < layout_.runs.size(); ++r) {
      LinkRun& run = layout_.runs[r];
      const int a = group_of_section_[at(run.section_a)];
      const int b = group_of_section_[at(run.section_b)];
      run.group = std::max(a, b);  // running before held
      if (!run.guarded && run.block < 0) {
        byIndex(run.group).runs.push_back(r);
      }
      if (a != b) {
        to_held[at(run.group)].push_back(r);
      }
    }
    for (std::size_t g = 0; g < to_held.size(); ++g) {
      if (!to_held[g].empty()) {
        addProxies(to_held[g], groups_.running[g]);
      }
    }
  }

  void addProxies(const std::vector<std::size_t>& runs, Group& group) {
    pad();
    std::map<std::pair<int, int>, int> known;  // slot and coordinates of a held end: its proxy
    for (const std::size_t r : runs) {
      LinkRun& run = layout_.runs[r];
      const bool held_is_a = group_of_section_[at(run.section_a)] == kHeld;
      int& stride = held_is_a ? run.stride_a : run.stride_b;
      const int dimensions = std::max(1, run.dimensions);
      for (LinkEnds& ends : run.ends) {
        int& end = held_is_a ? ends.a : ends.b;
        const auto [proxy, is_new] = known.try_emplace({end, dimensions}, layout_.slots());
        for (int k = 0; k < dimensions && is_new; ++k) {
          group.proxies.push_back({addSlot(k), end + k * stride});
        }
        end = proxy->second;
      }
      stride = run.dimensions == 0 ? 0 : 1;
    }
    pad();
  }

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

  const scene::Scene& scene_;
  Layout& layout_;
  int ratio_;
  std::vector<int> group_of_section_;  // index in Groups::running, or kHeld
  Groups groups_;
};

}  // namespace

Group everythingOf(const Layout& layout) {
  const auto all = [](auto& indices, std::size_t count) {
    indices.resize(count);
    std::iota(indices.begin(), indices.end(), 0);
  };
  Group everything;
  all(everything.sections, layout.sections.size());
  all(everything.feeds, layout.feeds.size());
  all(everything.modal_places, layout.modal_places.size());
  all(everything.places, layout.places.size());
  all(everything.projections, layout.projections.size());
  return everything;
}

std::vector<std::string> describeGroups(const scene::Scene& scene,
                                        const Groups& groups,
                                        int threads) {
  const auto describe = [&scene](const Group& group) {
    std::string text;
    for (const int section : group.sections) {
      text += (text.empty() ? "'" : ", '") + scene.sections[at(section)].name + "'";
    }
    return text + ", " + std::to_string(group.modules) + " modules";
  };
  std::vector<std::string> lines;
  if (!groups.held.sections.empty()) {
    lines.push_back("held while the others run: " + describe(groups.held));
  }
  for (const Group& group : groups.running) {
    lines.push_back("stepped together: " + describe(group));
  }
  lines.push_back(groups.running.size() < 2
                      ? "threads: 1, as all that runs is one group; a section is never divided"
                      : "threads: " + std::to_string(threads) + " for " +
                            std::to_string(groups.running.size()) + " independent groups");
  return lines;
}

Groups splitIntoGroups(const scene::Scene& scene, const Rates& rates, Layout& layout) {
  return Dealer(scene, rates, layout).deal();
}

}  // namespace ergotic::physics
