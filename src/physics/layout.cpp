// SPDX-License-Identifier: BSD-3-Clause
#include "layout.hpp"

#include <string>

#include "ergotic/exception.hpp"
#include "layout_links.hpp"
#include "step_units.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

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

void placeMats(const scene::Scene& scene, const Rates& rates, Layout& layout) {
  const int sections = static_cast<int>(scene.sections.size());
  std::vector<std::vector<int>> bins(at(3 * sections));
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    const scene::Mat& mat = scene.mats[at(m)];
    if (mat.type != MatType::kPoint) {
      bins[at(3 * mat.section + rankOf(scene, mat))].push_back(m);
    }
  }
  layout.slot_of_mat.resize(scene.mats.size());
  for (int s = 0; s < sections; ++s) {
    SectionRange range;
    range.divisor = divisorOf(scene.sections[at(s)], rates);
    range.dimensions = dimensionsOf(scene.sections[at(s)].geometry);
    range.cells = layout.slots();
    range.masses = range.cells + static_cast<int>(bins[at(3 * s)].size());
    range.fixed = range.masses + static_cast<int>(bins[at(3 * s + 1)].size());
    range.end = range.fixed + static_cast<int>(bins[at(3 * s + 2)].size());
    range.stride = range.end - range.cells;
    for (int c = 0; c < range.dimensions; ++c) {
      for (int bin = 3 * s; bin < 3 * s + 3; ++bin) {
        for (const int m : bins[at(bin)]) {
          if (c == 0) {
            layout.slot_of_mat[at(m)] = layout.slots();
          }
          layout.mat_of_slot.push_back(m);
          layout.component.push_back(c);
        }
      }
    }
    layout.sections.push_back(range);
  }
}

Tap describeTap(const scene::Scene& scene,
                const Rates& rates,
                const scene::Output& output,
                const Layout& layout) {
  const scene::Mat& mat = scene.mats[at(output.point.mat)];
  Tap tap;
  const auto slotOf = [&](int m) {
    return layout.slot_of_mat[at(m)] + output.axis * layout.strideOf(scene, m);
  };
  tap.quantity = output.quantity;
  tap.slot = slotOf(output.point.mat);
  tap.rest = mat.rest[output.axis];
  if (output.point.next >= 0) {
    const double f = output.point.fraction;
    tap.next = slotOf(output.point.next);
    tap.fraction = f;
    tap.rest = (1.0 - f) * tap.rest + f * scene.mats[at(output.point.next)].rest[output.axis];
  }
  tap.divisor = layout.sections[at(mat.section)].divisor;
  tap.velocity = 1.0 / StepUnits(scene, rates, tap.divisor).step;
  tap.channel = output.channel;
  if (mat.type == MatType::kPoint && tap.quantity == scene::Quantity::kForce && tap.divisor > 1) {
    throw Exception("output '" + output.name +
                    "' hears the force on a point of a section slower than audio, allowed: a "
                    "module beside it");
  }
  return tap;
}

bool follows(const scene::Value& v) {
  return v.audio >= 0;
}

void findFollowers(const scene::Scene& scene, Layout& layout) {
  for (int r = 0; r < static_cast<int>(layout.runs.size()); ++r) {
    const LinkRun& run = layout.runs[at(r)];
    for (int l = 0; l < static_cast<int>(run.lias.size()); ++l) {
      const scene::Lia& lia = scene.lias[at(run.lias[at(l)])];
      if (follows(lia.stiffness) || follows(lia.damping) || follows(lia.nonlinearity)) {
        layout.followers.push_back({r, l, run.section});
      }
    }
  }
  for (int slot = 0; slot < layout.slots(); ++slot) {
    if (layout.mat_of_slot[at(slot)] < 0) {
      continue;
    }
    const scene::Mat& mat = scene.mats[at(layout.mat_of_slot[at(slot)])];
    if (layout.component[at(slot)] == 0 && mat.type == MatType::kCell &&
        (follows(mat.stiffness) || follows(mat.damping))) {
      layout.followers.push_back({-1, slot, mat.section});
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
  placeMats(scene, rates, layout);
  placeConnections(scene, layout);
  placeLinks(scene, layout);
  for (const scene::Port& port : scene.ports) {
    layout.port_slots.push_back(layout.slot_of_mat[at(port.mat)]);
  }
  for (const scene::Output& output : scene.outputs) {
    layout.taps.push_back(describeTap(scene, rates, output, layout));
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
  return layout;
}

}  // namespace ergotic::physics
