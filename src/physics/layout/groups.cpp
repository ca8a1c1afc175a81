// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/groups.hpp"

#include <algorithm>
#include <numeric>

#include "at.hpp"
#include "physics/layout/energy_stable_groups.hpp"
#include "physics/layout/partition.hpp"

namespace ergotic::physics {
namespace {

/// Deals everything out to the groups of its sections.
class Dealer {
 public:
  Dealer(const scene::Scene& scene, const Rates& rates, const Layout& layout)
      : scene_(scene), layout_(layout) {
    groups_.running.resize(layout.proxies.size());
    for (int s = 0; s < static_cast<int>(layout.sections.size()); ++s) {
      const SectionRange& range = layout.sections[at(s)];
      if (range.stride > 0) {
        Group& group = groupOf(s);
        group.sections.push_back(s);
        group.modules += range.stride;
        group.cost += costOf(range, rates);
      }
    }
    for (std::size_t g = 0; g < layout.proxies.size(); ++g) {
      groups_.running[g].proxies = layout.proxies[g];
    }
  }

  Groups deal() {
    dealRuns();
    dealBySection(layout_.taps, &Group::taps, [](const auto& t) { return t.section; });
    dealBySection(layout_.places, &Group::places, [](const auto& p) { return p.section; });
    dealBySection(layout_.interpolated, &Group::interpolated,
                  [](const auto& g) { return g.section; });
    dealBySection(layout_.interpolated, &Group::answered,
                  [](const auto& g) { return g.of.section; });
    dealBySection(layout_.projections, &Group::projections,
                  [](const auto& p) { return p.of.section; });
    dealBySection(layout_.feeds, &Group::feeds, [](const auto& f) { return f.section; });
    dealBySection(layout_.followers, &Group::followers, [](const auto& f) { return f.section; });
    for (std::size_t b = 0; b < layout_.blocks.size(); ++b) {
      if (layout_.blocks[b].is_alone) {
        groupOf(layout_.blocks[b].section).lone.push_back({b, {}, {}});
      }
    }
    for (std::size_t k = 0; k < layout_.pickups.size(); ++k) {
      dealPickup(k, groupOf(scene_.mats[at(scene_.outputs[k].point.mat)].section));
    }
    const std::vector<EnergyStableGroup> energy_stable = energyStableGroupsOf(layout_);
    for (std::size_t g = 0; g < energy_stable.size(); ++g) {
      byIndex(energy_stable[g].group).energy_stable.push_back(g);
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
           group.energy_stable.empty() && group.taps.empty() && group.places.empty() &&
           group.interpolated.empty() && group.projections.empty() && group.feeds.empty() &&
           group.followers.empty() && group.pickups.empty() && group.proxies.empty();
  }

  Group& byIndex(int g) { return g == LinkRun::kHeldGroup ? groups_.held : groups_.running[at(g)]; }
  Group& groupOf(int section) { return byIndex(layout_.group_of_section[at(section)]); }

  template <class Item, class SectionOf>
  void dealBySection(const std::vector<Item>& items,
                     std::vector<std::size_t> Group::*to,
                     const SectionOf& section_of) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      (groupOf(section_of(items[i])).*to).push_back(i);
    }
  }

  void dealPickup(std::size_t k, Group& group) {
    const int channel = layout_.pickups[k].channel;
    const auto known = std::find(group.channels.begin(), group.channels.end(), channel);
    const int block = layout_.blockOf(layout_.pickups[k].slot);
    const auto lone = std::find_if(group.lone.begin(), group.lone.end(), [&](const LoneBlock& l) {
      return static_cast<int>(l.block) == block;
    });
    auto& pickups = lone == group.lone.end() ? group.pickups : lone->pickups;
    auto& columns = lone == group.lone.end() ? group.pickup_columns : lone->pickup_columns;
    pickups.push_back(k);
    columns.push_back(static_cast<std::size_t>(known - group.channels.begin()));
    if (known == group.channels.end()) {
      group.channels.push_back(channel);
    }
  }

  void dealRuns() {
    for (std::size_t r = 0; r < layout_.runs.size(); ++r) {
      const LinkRun& run = layout_.runs[r];
      if (!run.energy_stable && run.block < 0) {
        byIndex(run.group).runs.push_back(r);
      }
    }
  }

  const scene::Scene& scene_;
  const Layout& layout_;
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
  all(everything.taps, layout.taps.size());
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

Groups makeGroups(const scene::Scene& scene, const Rates& rates, const Layout& layout) {
  return Dealer(scene, rates, layout).deal();
}

}  // namespace ergotic::physics
