// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/layout_links.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/scene/grid.hpp"
#include "physics/layout/link_spans.hpp"
#include "scene/laws/bend_parts.hpp"
#include "scene/pressers.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;

/// Slots for a point: those of its coordinates follow one another.
int addSlots(Layout& layout, int dimensions, int mat) {
  const int first = layout.slots();
  for (int c = 0; c < dimensions; ++c) {
    layout.mat_of_slot.push_back(mat);
    layout.component.push_back(c);
  }
  return first;
}

/// Index of a slice as a section sees it interpolated, which is made where there is none.
std::size_t interpolatedSlice(
    const scene::Scene& scene, const Rates& rates, int mat, int section, Layout& layout) {
  const int slot = layout.slot_of_mat[at(mat)];
  const auto known = std::find_if(layout.interpolated.begin(), layout.interpolated.end(),
                                  [&](const InterpolatedSlice& slice) {
                                    return slice.of.slot == slot && slice.section == section;
                                  });
  if (known != layout.interpolated.end()) {
    return static_cast<std::size_t>(known - layout.interpolated.begin());
  }
  const scene::Mat& slice = scene.mats[at(mat)];
  InterpolatedSlice seen;
  seen.dimensions = layout.sections[at(slice.section)].dimensions;
  seen.coordinate = static_cast<int>(coordinatesOf(layout.interpolated));
  seen.slot = addSlots(layout, seen.dimensions, -1);
  seen.section = section;
  seen.of = {slot, layout.strideOf(scene, mat), slice.section, slice.rest};
  seen.steps = interpolationSteps(rates.ratio / layout.sections[at(section)].divisor);
  layout.interpolated.push_back(std::move(seen));
  return layout.interpolated.size() - 1;
}

/// Slots and frames of the ends of links.
class Ends {
 public:
  Ends(const scene::Scene& scene, const Rates& rates, Layout& layout)
      : scene_(scene), rates_(rates), layout_(layout) {}

  End of(int mat) const {
    const scene::Mat& m = scene_.mats[at(mat)];
    return {layout_.slot_of_mat[at(mat)], layout_.strideOf(scene_, mat), m.section, m.rest};
  }

  /// The module as another one sees it, in the frame of this section.
  End seen(int mat, int by, bool projects, int frame) {
    const int section = scene_.mats[at(by)].section;
    const bool interpolated = physics::isInterpolated(scene_, rates_, mat, section);
    End end =
        interpolated
            ? endOf(layout_.interpolated[interpolatedSlice(scene_, rates_, mat, section, layout_)])
            : of(mat);
    if (!projects) {
      return end;
    }
    const auto [known, is_new] = projections_.try_emplace({end.slot, frame});
    if (is_new) {
      known->second = project(mat, end, interpolated ? section : end.section, frame);
    }
    return known->second;
  }
  bool isInterpolated(const scene::Lia& lia) const {
    return physics::isInterpolated(scene_, rates_, lia);
  }

  const std::string& file() const { return scene_.file; }
  int divisor(int section) const { return layout_.sections[at(section)].divisor; }

 private:
  /// The end that an interpolated slice makes: of the section of the slice, whoever steps it.
  static End endOf(const InterpolatedSlice& slice) {
    return {slice.slot, 1, slice.of.section, slice.of.rest};
  }

  /// \param steps  the section whose steps it follows
  End project(int mat, const End& end, int steps, int frame) {
    const scene::Section& to = scene_.sections[at(frame)];
    const scene::Section& from = scene_.sectionOf(scene_.mats[at(mat)]);
    const Eigen::Isometry3d map = to.pose.inverse() * from.pose;
    ProjectedPoint point;
    point.dimensions = dimensionsOf(to.geometry);
    point.of = end;
    point.of.section = steps;
    point.source_dimensions = dimensionsOf(from.geometry);
    point.axes = map.linear();
    point.slot = addSlots(layout_, point.dimensions, -1);
    layout_.projections.push_back(point);
    return {point.slot, 1, end.section, map * end.rest};
  }

  const scene::Scene& scene_;
  const Rates& rates_;
  Layout& layout_;
  std::map<std::pair<int, int>, End> projections_;  // of a slot in the frame of a section
};

/// The frame in which two modules meet: that of the one with fewer coordinates.
struct LinkFrame {
  int section = 0;
  bool projects_a = false;
  bool projects_b = false;
};

LinkFrame frameOf(const scene::Scene& scene, const scene::Lia& lia) {
  const int sa = scene.mats[at(lia.a)].section;
  const int sb = scene.mats[at(lia.b)].section;
  const scene::Section& a = scene.sections[at(sa)];
  const scene::Section& b = scene.sections[at(sb)];
  if (a.geometry == b.geometry) {
    // Scalar sections have one axis in common whatever their place in the picture.
    const bool same =
        sa == sb || a.geometry == Geometry::kScalar || a.pose.matrix() == b.pose.matrix();
    return {sa, false, !same};
  }
  return a.geometry < b.geometry ? LinkFrame{sa, false, true} : LinkFrame{sb, true, false};
}

/// Sets the section whose steps a link follows: the faster one of its two.
void setRates(const scene::Lia& lia, const End& a, const End& b, const Ends& ends, LinkRun& run) {
  const int da = ends.divisor(a.section);
  const int db = ends.divisor(b.section);
  const int fast = std::min(da, db);
  const int slow = std::max(da, db);
  if (slow % fast != 0) {
    throw TextError(ends.file(), lia.place.line, lia.place.column,
                    "link '" + lia.name + "' joins sections stepped every " + std::to_string(fast) +
                        " and " + std::to_string(slow) +
                        " audio frames: one must be a multiple of the other");
  }
  run.section = da <= db ? a.section : b.section;
  run.interpolated = ends.isInterpolated(lia);
  if (da != db && !run.interpolated) {
    run.slow_is_a = da > db;
    run.slow_section = run.slow_is_a ? a.section : b.section;
    run.share = static_cast<double>(fast) / slow;
  }
}

void placeLink(const scene::Scene& scene, int l, Ends& ends, LinkRun& run, End& a, End& b) {
  const scene::Lia& lia = scene.lias[at(l)];
  const LinkFrame frame = frameOf(scene, lia);
  const Geometry geometry = scene.sections[at(frame.section)].geometry;
  a = ends.seen(lia.a, lia.b, frame.projects_a, frame.section);
  b = ends.seen(lia.b, lia.a, frame.projects_b, frame.section);
  run.law = lia.type;
  run.energy_stable = lia.scheme == scene::Scheme::kEnergyStable;
  run.tank = run.energy_stable && lia.type == scene::LiaType::kCubic ? lia.tank : -1;
  run.is_mean = run.tank >= 0 && scene.tanks[at(run.tank)].is_mean;
  run.dimensions = geometry == Geometry::kScalar ? 0 : dimensionsOf(geometry);
  run.section_a = a.section;
  run.section_b = b.section;
  setRates(lia, a, b, ends, run);
  run.stride_a = run.dimensions == 0 ? 0 : a.stride;
  run.stride_b = run.dimensions == 0 ? 0 : b.stride;
}

/// [mats] 1 where links, inputs or outputs end, and what leads a point.
std::vector<unsigned char> usedMats(const scene::Scene& scene) {
  std::vector<unsigned char> is_used(scene.mats.size(), 0);
  for (const scene::Lia& lia : scene.lias) {
    is_used[at(lia.a)] = is_used[at(lia.b)] = 1;
  }
  for (const scene::Input& input : scene.inputs) {
    is_used[at(input.mat)] = 1;
  }
  for (const scene::Output& output : scene.outputs) {
    is_used[at(output.point.mat)] = 1;
    is_used[at(output.point.next < 0 ? output.point.mat : output.point.next)] = 1;
  }
  for (const scene::Connection& place : scene.connections) {
    for (const scene::Connection::Way& way : {place.along, place.across}) {
      if (way.guide >= 0) {
        is_used[at(way.guide)] = 1;
      }
    }
  }
  return is_used;
}

TapPoint tapOf(const scene::Scene& scene, const scene::Tap& tap, const Layout& layout) {
  TapPoint point;
  point.mat = tap.mat;
  point.section = scene.mats[at(tap.mat)].section;
  const SectionRange& range = layout.sections[at(point.section)];
  point.dimensions = range.dimensions;
  point.stride = range.stride;
  point.offset = tap.offset;
  std::vector<std::pair<int, double>> shares;  // by slot
  for (const scene::Tap::Share& share : tap.shares) {
    shares.emplace_back(layout.slot_of_mat[at(share.mat)], share.weight);
  }
  std::sort(shares.begin(), shares.end());
  for (const auto& [slot, weight] : shares) {
    if (point.spans.empty() || slot != point.spans.back().first + point.spans.back().count) {
      point.spans.push_back({slot, 0});
    }
    ++point.spans.back().count;
    point.weights.push_back(weight);
  }
  return point;
}

/// Whether a friction has a tangent of the contact that presses it: both act in one plane or space.
bool haveTangent(const scene::Scene& scene, const scene::Lia& lia, const scene::Lia& by) {
  const scene::Section& one = scene.sections[at(frameOf(scene, lia).section)];
  const scene::Section& other = scene.sections[at(frameOf(scene, by).section)];
  return one.geometry == other.geometry && dimensionsOf(one.geometry) > 1 &&
         one.pose.matrix() == other.pose.matrix();
}

/// \param pressers  of scene::pressersOf
void placePressings(const scene::Scene& scene, const std::vector<int>& pressers, Layout& layout) {
  std::map<int, std::pair<std::size_t, std::size_t>> places;  // of links that press
  for (std::size_t r = 0; r < layout.runs.size(); ++r) {
    for (std::size_t l = 0; layout.runs[r].presses && l < layout.runs[r].lias.size(); ++l) {
      places[layout.runs[r].lias[l]] = {r, l};
    }
  }
  for (std::size_t r = 0; r < layout.runs.size() && !pressers.empty(); ++r) {
    for (std::size_t l = 0; l < layout.runs[r].lias.size(); ++l) {
      const int lia = layout.runs[r].lias[l];
      if (const int by = pressers[at(lia)]; by >= 0) {
        const auto [by_run, by_link] = places.at(by);
        const bool is_tangent = haveTangent(scene, scene.lias[at(lia)], scene.lias[at(by)]);
        layout.pressings.push_back({r, l, by_run, by_link, is_tangent});
      }
    }
  }
}

}  // namespace

void placeTaps(const scene::Scene& scene, Layout& layout) {
  const std::vector<unsigned char> is_used = usedMats(scene);
  for (const scene::Tap& tap : scene.taps) {
    TapPoint point = tapOf(scene, tap, layout);
    if (is_used[at(tap.mat)] != 0) {
      point.slot = addSlots(layout, point.dimensions, tap.mat);
      layout.slot_of_mat[at(tap.mat)] = point.slot;
    }
    (point.slot < 0 ? layout.seen_taps : layout.taps).push_back(std::move(point));
  }
  std::sort(layout.seen_taps.begin(), layout.seen_taps.end(),
            [](const TapPoint& a, const TapPoint& b) { return a.mat < b.mat; });
}

/// The slot of the coordinate that leads, as a section sees it.
int guideOf(const scene::Scene& scene,
            const Rates& rates,
            const scene::Connection::Way& way,
            int section,
            Layout& layout) {
  if (way.guide < 0) {
    return -1;
  }
  if (isInterpolated(scene, rates, way.guide, section)) {
    return layout.interpolated[interpolatedSlice(scene, rates, way.guide, section, layout)].slot +
           way.axis;
  }
  return layout.slot_of_mat[at(way.guide)] + way.axis * layout.strideOf(scene, way.guide);
}

/// Whether a place on a scalar body is led by nothing: it is a weighted sum that stays, then.
bool isFixed(const scene::Scene& scene, const scene::Connection& connection) {
  const auto stays = [](const scene::Connection::Way& way) {
    return way.guide < 0 && way.at.parameter < 0 && way.at.audio < 0;
  };
  const scene::Section& section = scene.sectionOf(scene.mats[at(connection.mat)]);
  return section.geometry == scene::Geometry::kScalar && stays(connection.along) &&
         stays(connection.across);
}

/// The tap that a fixed place is; nothing if it lies on points.
std::optional<scene::Tap> fixedTapOf(const scene::Scene& scene,
                                     const scene::Connection& connection) {
  const scene::GridPlace around = scene::placeOf(scene, connection);
  scene::Tap tap;
  tap.mat = connection.mat;
  for (std::size_t i = 0; i < at(around.count); ++i) {
    const scene::Mat& there = scene.mats[at(around.mats[i])];
    if (there.type == scene::MatType::kPoint) {
      return std::nullopt;
    }
    tap.shares.push_back({around.mats[i], around.weights[i]});
    tap.offset += around.weights[i] * (there.rest.x() - scene.mats[at(tap.mat)].rest.x());
  }
  return tap;
}

void placeConnections(const scene::Scene& scene, const Rates& rates, Layout& layout) {
  for (int k = 0; k < static_cast<int>(scene.connections.size()); ++k) {
    const scene::Connection& connection = scene.connections[at(k)];
    if (isFixed(scene, connection)) {
      if (const auto tap = fixedTapOf(scene, connection)) {
        TapPoint point = tapOf(scene, *tap, layout);
        point.slot = addSlots(layout, point.dimensions, tap->mat);
        point.is_place = true;
        layout.slot_of_mat[at(tap->mat)] = point.slot;
        layout.taps.push_back(std::move(point));
        continue;
      }
    }
    PlacePoint point;
    point.section = scene.mats[at(scene.grids[at(connection.grid)].first)].section;
    const SectionRange& range = layout.sections[at(point.section)];
    point.dimensions = range.dimensions;
    point.stride = range.stride;
    point.coordinate = static_cast<int>(coordinatesOf(layout.places));
    point.slot = addSlots(layout, point.dimensions, connection.mat);
    point.connection = k;
    point.guides = {guideOf(scene, rates, connection.along, point.section, layout),
                    guideOf(scene, rates, connection.across, point.section, layout)};
    layout.slot_of_mat[at(connection.mat)] = point.slot;
    layout.places.push_back(point);
  }
}

void placeLinks(const scene::Scene& scene, const Rates& rates, Layout& layout) {
  using Key = std::tuple<scene::LiaType, bool, bool, int, int, int, int, int, int, int, int, int>;
  const std::vector<int> pressers = scene::pressersOf(scene);
  const std::set<int> pressing(pressers.begin(), pressers.end());
  std::map<Key, std::size_t> known;
  Ends ends(scene, rates, layout);
  std::vector<int> block_of_lia(scene.lias.size(), -1);
  for (int b = 0; b < static_cast<int>(layout.blocks.size()); ++b) {
    for (const int l : layout.blocks[at(b)].lias) {
      block_of_lia[at(l)] = b;
    }
    layout.blocks[at(b)].lias = {};
  }
  for (int l = 0; l < static_cast<int>(scene.lias.size()); ++l) {
    LinkRun run;
    End a;
    End b;
    placeLink(scene, l, ends, run, a, b);
    run.block = block_of_lia[at(l)];
    run.presses = pressing.count(l) > 0;
    const Key key{run.law,      run.energy_stable, run.presses,   run.dimensions,
                  run.section,  run.section_a,     run.section_b, run.stride_a,
                  run.stride_b, run.slow_section,  run.block,     run.tank};
    const auto [found, is_new] = known.emplace(key, layout.runs.size());
    if (is_new) {
      layout.runs.push_back(std::move(run));
    }
    LinkRun& target = layout.runs[found->second];
    target.lias.push_back(l);
    target.ends.push_back({a.slot, b.slot});
    if (target.block < 0) {
      const scene::Lia& lia = scene.lias[at(l)];
      target.rests.push_back(lia.bend < 0 ? a.rest - b.rest : scene::restApart(scene, lia));
    }
  }
  for (LinkRun& run : layout.runs) {
    arrangeInSpans(run);
  }
  placePressings(scene, pressers, layout);
}

}  // namespace ergotic::physics
