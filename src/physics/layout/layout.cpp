// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/layout.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "at.hpp"
#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "physics/layout/blocks/lanes.hpp"
#include "physics/layout/layout_links.hpp"
#include "physics/layout/partition.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;

/// Modules that lose speed by themselves are stepped like cells.
int rankOf(const scene::Scene& scene, const scene::Mat& mat) {
  switch (mat.type) {
    case MatType::kCell:
      return 0;
    case MatType::kMass:
      return scene.sectionOf(mat).medium.factor != 0.0 ? 0 : 1;
    default:
      return 2;
  }
}

/// Fills slots.
class MatPlacer {
 public:
  MatPlacer(const scene::Scene& scene, const Rates& rates, Layout& layout)
      : scene_(scene), rates_(rates), layout_(layout), bins_(3 * scene.sections.size()) {
    layout.slot_of_mat.assign(scene.mats.size(), -1);
    blocks_ = findBlocks(scene);
    std::vector<unsigned char> is_in_block(scene.mats.size(), 0);
    for (const Block& block : blocks_) {
      for (const int m : block.mats) {
        if (m >= 0) {
          is_in_block[at(m)] = 1;
        }
      }
    }
    for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
      const scene::Mat& mat = scene.mats[at(m)];
      if (mat.type != MatType::kPoint && is_in_block[at(m)] == 0) {
        bins_[at(3 * mat.section + rankOf(scene, mat))].push_back(m);
      }
    }
  }

  void place() {
    for (int s = 0; s < static_cast<int>(scene_.sections.size()); ++s) {
      const std::vector<int>* bins = &bins_[at(3 * s)];
      SectionRange range;
      range.divisor = divisorOf(scene_.sections[at(s)], rates_);
      range.dimensions = dimensionsOf(scene_.sections[at(s)].geometry);
      range.first = layout_.slots();
      placeBlocks(s);
      range.cells = layout_.slots();
      range.masses = range.cells + static_cast<int>(bins[0].size());
      range.fixed = range.masses + static_cast<int>(bins[1].size());
      range.end = range.fixed + static_cast<int>(bins[2].size());
      range.stride = range.end - range.first;
      for (int c = 0; c < range.dimensions; ++c) {
        for (int bin = 0; bin < 3; ++bin) {
          for (const int m : bins[bin]) {
            add(m, c);
          }
        }
      }
      layout_.sections.push_back(range);
    }
  }

 private:
  void add(int mat, int component) {
    if (mat >= 0 && component == 0) {
      layout_.slot_of_mat[at(mat)] = layout_.slots();
    }
    layout_.mat_of_slot.push_back(mat);
    layout_.component.push_back(component);
  }

  void pad(int count) {
    for (int i = 0; i < count; ++i) {
      add(-1, 0);
    }
  }

  /// Blocks begin at multiples of kLanes, with their guards around them.
  void placeBlocks(int section) {
    for (Block& block : blocks_) {
      if (block.section != section) {
        continue;
      }
      const int past = layout_.slots() % kLanes;
      pad((past == 0 ? 0 : kLanes - past) + block.guard);
      block.first = layout_.slots();
      for (const int m : block.mats) {
        add(m, 0);
      }
      block.mats = {};
      pad(block.guard);
      layout_.blocks.push_back(std::move(block));
    }
  }

  const scene::Scene& scene_;
  const Rates& rates_;
  Layout& layout_;
  std::vector<std::vector<int>> bins_;  // [sections][cells, masses, fixed]
  std::vector<Block> blocks_;
};

Pickup describePickup(const scene::Scene& scene,
                      const Rates& rates,
                      const scene::Output& output,
                      const Layout& layout) {
  const scene::Mat& mat = scene.mats[at(output.point.mat)];
  Pickup pickup;
  const auto slotOf = [&](int m) {
    return layout.slot_of_mat[at(m)] + output.axis * layout.strideOf(scene, m);
  };
  pickup.quantity = output.quantity;
  pickup.slot = slotOf(output.point.mat);
  pickup.rest = mat.rest[output.axis];
  if (output.point.next >= 0) {
    const double f = output.point.fraction;
    pickup.next = slotOf(output.point.next);
    pickup.fraction = f;
    pickup.rest = (1.0 - f) * pickup.rest + f * scene.mats[at(output.point.next)].rest[output.axis];
  }
  pickup.divisor = layout.sections[at(mat.section)].divisor;
  pickup.velocity = 1.0 / StepUnits(scene, rates, pickup.divisor).step;
  pickup.channel = output.channel;
  if (mat.type == MatType::kPoint && pickup.quantity == scene::Quantity::kForce &&
      pickup.divisor > 1) {
    throw Exception("output '" + output.name +
                    "' hears the force on a point of a section slower than audio, allowed: a "
                    "module beside it");
  }
  return pickup;
}

/// Of a high pass of first order by the bilinear rule, with its corner where it is asked for.
double poleOfRadiation(double corner_hz, double rate_hz) {
  constexpr double kHighest = 0.49;  // of the rate
  const double t = std::tan(kPi * std::min(corner_hz / rate_hz, kHighest));
  return (1.0 - t) / (1.0 + t);
}

bool follows(const scene::Value& v) {
  return v.audio >= 0;
}

bool followsAudio(const scene::Mat& mat) {
  const bool is_cell = mat.type == MatType::kCell;
  return (is_cell || mat.type == MatType::kMass) &&
         (follows(mat.mass) || (is_cell && (follows(mat.stiffness) || follows(mat.damping))));
}

void findFollowers(const scene::Scene& scene, Layout& layout) {
  for (int r = 0; r < static_cast<int>(layout.runs.size()); ++r) {
    const LinkRun& run = layout.runs[at(r)];
    for (int l = 0; l < static_cast<int>(run.lias.size()); ++l) {
      const scene::Lia& lia = scene.lias[at(run.lias[at(l)])];
      if (follows(lia.stiffness) || follows(lia.damping) || follows(lia.law->nonlinearity) ||
          follows(lia.law->width)) {
        layout.followers.push_back({r, l, run.section});
      }
    }
  }
  for (int slot = 0; slot < layout.slots(); ++slot) {
    if (layout.mat_of_slot[at(slot)] < 0) {
      continue;
    }
    const scene::Mat& mat = scene.mats[at(layout.mat_of_slot[at(slot)])];
    if (layout.component[at(slot)] == 0 && followsAudio(mat)) {
      layout.followers.push_back({Follower::kModule, slot, mat.section});
    }
  }
  for (int p = 0; p < static_cast<int>(layout.places.size()); ++p) {
    const PlacePoint& point = layout.places[at(p)];
    const scene::Connection& connection = scene.connections[at(point.connection)];
    if (follows(connection.along.at) || follows(connection.across.at)) {
      layout.followers.push_back({Follower::kPlace, p, point.section});
    }
  }
}

}  // namespace

int Layout::strideOf(const scene::Scene& scene, int mat) const {
  const scene::Mat& m = scene.mats[at(mat)];
  return m.type == MatType::kPoint ? 1 : sections[at(m.section)].stride;
}

Layout makeLayout(const scene::Scene& scene, const Rates& rates) {
  Layout layout;
  MatPlacer(scene, rates, layout).place();
  placeTaps(scene, layout);
  placeConnections(scene, rates, layout);
  placeLinks(scene, rates, layout);
  for (const scene::Port& port : scene.ports) {
    layout.port_slots.push_back(layout.slot_of_mat[at(port.mat)] +
                                port.axis * layout.strideOf(scene, port.mat));
  }
  for (const scene::Output& output : scene.outputs) {
    layout.pickups.push_back(describePickup(scene, rates, output, layout));
    if (output.radiation_hz > 0.0) {
      layout.pickups.back().radiation = layout.radiations++;
      layout.pickups.back().pole = poleOfRadiation(output.radiation_hz, rates.audio_hz);
    }
  }
  for (const scene::Input& input : scene.inputs) {
    const scene::Mat& mat = scene.mats[at(input.mat)];
    const int divisor = layout.sections[at(mat.section)].divisor;
    const int slot =
        layout.slot_of_mat[at(input.mat)] + input.axis * layout.strideOf(scene, input.mat);
    layout.feeds.push_back(
        {input.quantity, slot, mat.rest[input.axis], mat.section, 1.0 / divisor, input.channel});
  }
  findFollowers(scene, layout);
  layout.group_of_section = partitionSections(scene, rates, layout);
  layout.first_proxy = layout.slots();
  placeProxies(layout);
  findLoneBlocks(scene, rates, layout);
  return layout;
}

}  // namespace ergotic::physics
