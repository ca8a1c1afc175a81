// SPDX-License-Identifier: BSD-3-Clause
#include "layout.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

#include "ergotic/exception.hpp"
#include "step_units.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::MatType;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int rankOf(MatType type) {
  switch (type) {
    case MatType::kCell:
      return 0;
    case MatType::kMass:
      return 1;
    default:
      return 2;
  }
}

void placeMats(const scene::Scene& scene, const Rates& rates, Layout& layout) {
  const int sections = static_cast<int>(scene.sections.size());
  std::vector<std::vector<int>> bins(at(3 * sections));
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    const scene::Mat& mat = scene.mats[at(m)];
    bins[at(3 * mat.section + rankOf(mat.type))].push_back(m);
  }
  layout.slot_of_mat.resize(scene.mats.size());
  const auto place = [&](int bin) {
    for (const int m : bins[at(bin)]) {
      layout.slot_of_mat[at(m)] = layout.slots();
      layout.mat_of_slot.push_back(m);
    }
  };
  for (int s = 0; s < sections; ++s) {
    SectionRange range;
    range.divisor = divisorOf(scene.sections[at(s)], rates);
    range.cells = layout.slots();
    place(3 * s);
    range.masses = layout.slots();
    place(3 * s + 1);
    range.fixed = layout.slots();
    place(3 * s + 2);
    range.end = layout.slots();
    layout.sections.push_back(range);
  }
}

/// Whose steps a link follows: the faster of its two sections.
LinkRun describeRun(const scene::Scene& scene, const scene::Lia& lia, const Layout& layout) {
  LinkRun run;
  run.law = lawOf(lia);
  const int sa = scene.mats[at(lia.a)].section;
  const int sb = scene.mats[at(lia.b)].section;
  const int da = layout.sections[at(sa)].divisor;
  const int db = layout.sections[at(sb)].divisor;
  run.section = da <= db ? sa : sb;
  if (da != db) {
    run.slow_is_a = da > db;
    run.slow_section = run.slow_is_a ? sa : sb;
    const int fast = std::min(da, db);
    const int slow = std::max(da, db);
    if (slow % fast != 0) {
      throw Exception("link '" + lia.name + "' joins sections stepped every " +
                      std::to_string(fast) + " and " + std::to_string(slow) +
                      " audio frames: one must be a multiple of the other");
    }
    run.share = static_cast<double>(fast) / slow;
  }
  return run;
}

void placeLias(const scene::Scene& scene, Layout& layout) {
  std::map<std::tuple<int, Law, int, bool>, std::size_t> known;
  for (int l = 0; l < static_cast<int>(scene.lias.size()); ++l) {
    const scene::Lia& lia = scene.lias[at(l)];
    LinkRun run = describeRun(scene, lia, layout);
    const auto key = std::make_tuple(run.section, run.law, run.slow_section, run.slow_is_a);
    const auto [found, is_new] = known.emplace(key, layout.runs.size());
    if (is_new) {
      layout.runs.push_back(std::move(run));
    }
    LinkRun& target = layout.runs[found->second];
    target.lias.push_back(l);
    target.ends.push_back({layout.slot_of_mat[at(lia.a)], layout.slot_of_mat[at(lia.b)]});
  }
}

Tap describeTap(const scene::Scene& scene,
                const Rates& rates,
                const scene::Output& output,
                const Layout& layout) {
  const scene::Mat& mat = scene.mats[at(output.point.mat)];
  Tap tap;
  tap.quantity = output.quantity;
  tap.slot = layout.slot_of_mat[at(output.point.mat)];
  tap.rest = mat.rest.x();
  if (output.point.next >= 0) {
    const double f = output.point.fraction;
    tap.next = layout.slot_of_mat[at(output.point.next)];
    tap.fraction = f;
    tap.rest = (1.0 - f) * mat.rest.x() + f * scene.mats[at(output.point.next)].rest.x();
  }
  tap.divisor = layout.sections[at(mat.section)].divisor;
  tap.velocity = 1.0 / StepUnits(scene, rates, tap.divisor).step;
  tap.channel = output.channel;
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
    const scene::Mat& mat = scene.mats[at(layout.mat_of_slot[at(slot)])];
    if (mat.type == MatType::kCell && (follows(mat.stiffness) || follows(mat.damping))) {
      layout.followers.push_back({-1, slot, mat.section});
    }
  }
}

}  // namespace

Law lawOf(const scene::Lia& lia) {
  switch (lia.type) {
    case LiaType::kSpringDamper:
      return Law::kSpringDamper;
    case LiaType::kContact:
      return Law::kContact;
    case LiaType::kQuadratic:
      return Law::kQuadratic;
    case LiaType::kCubic:
      return Law::kCubic;
    case LiaType::kClippedCubic:
      return Law::kClippedCubic;
    case LiaType::kCubicContact:
      return Law::kCubicContact;
    case LiaType::kPluck:
      return lia.table.empty() ? Law::kPluck : Law::kPluckTable;
    case LiaType::kBow:
      return lia.table.empty() ? Law::kBow : Law::kBowTable;
    case LiaType::kSmoothBow:
      return Law::kSmoothBow;
    case LiaType::kPowerContact:
    case LiaType::kTable:
    case LiaType::kConditional:
      break;
  }
  throw Exception("link '" + lia.name + "' has no force law");
}

Layout makeLayout(const scene::Scene& scene, const Rates& rates) {
  Layout layout;
  placeMats(scene, rates, layout);
  placeLias(scene, layout);
  for (const scene::Port& port : scene.ports) {
    layout.port_slots.push_back(layout.slot_of_mat[at(port.mat)]);
  }
  for (const scene::Output& output : scene.outputs) {
    layout.taps.push_back(describeTap(scene, rates, output, layout));
  }
  for (const scene::Input& input : scene.inputs) {
    const scene::Mat& mat = scene.mats[at(input.mat)];
    const int divisor = layout.sections[at(mat.section)].divisor;
    layout.feeds.push_back({input.quantity, layout.slot_of_mat[at(input.mat)], mat.rest.x(),
                            mat.section, 1.0 / divisor, input.channel});
  }
  findFollowers(scene, layout);
  return layout;
}

}  // namespace ergotic::physics
