// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "physics/interpolation.hpp"
#include "physics/layout/blocks/blocks.hpp"
#include "physics/layout/blocks/link_ends.hpp"

namespace ergotic::physics {

/// Slots of a section. A slot is one coordinate of one module. Each coordinate of a section fills
/// `stride` slots in a row: blocks (blocks.hpp; their grounds are masses that no force moves),
/// cells, masses, then modules that forces do not move; those of y follow those of x. The ranges
/// are those of x.
struct SectionRange {
  int divisor = 1;  ///< audio frames per step
  int dimensions = 1;
  int stride = 0;
  int first = 0;   ///< slot, of blocks
  int cells = 0;   ///< first slot
  int masses = 0;  ///< first slot
  int fixed = 0;   ///< first slot
  int end = 0;
};

/// One end of a link: coordinate c lies in slot + c * stride.
struct End {
  int slot = 0;
  int stride = 0;
  int section = 0;
  Eigen::Vector3d rest = Eigen::Vector3d::Zero();
};

/// A run of links with one law, stepped with one section. Where `slow_section` is set, end a (or
/// b) belongs to that slower section: its position is held between its steps and it receives
/// `share` of the force at every step, so the mean over its own step.
struct LinkRun {
  scene::LiaType law = scene::LiaType::kSpringDamper;
  bool energy_stable = false;
  int dimensions = 0;  ///< 0: scalar, else the coordinates a distance is taken over
  int section = 0;     ///< section whose steps it follows
  int section_a = 0;   ///< section of the modules at end a
  int section_b = 0;
  int slow_section = -1;
  bool slow_is_a = false;
  double share = 1.0;
  bool interpolated = false;  ///< one end is a slice that is interpolated: then none is slow
  bool presses = false;       ///< frictions read its forces
  int tank = -1;              ///< index in Scene::tanks: from which its links take their energy
  bool is_mean = false;       ///< Tank::is_mean
  static constexpr int kHeldGroup = -1;
  int group = kHeldGroup;  ///< group that steps it, as in Layout::group_of_section
  int block = -1;          ///< index in Layout::blocks: its sweep works these links out
  int stride_a = 0;
  int stride_b = 0;
  std::vector<int> lias;               ///< [links] index in Scene::lias
  std::vector<LinkEnds> ends;          ///< [links]
  std::vector<Eigen::Vector3d> rests;  ///< [links] rest of a less rest of b
  std::vector<LinkSpan> spans;  ///< all links, as kernels take them side by side; empty: one by one
};

/// A friction, and the contact whose force is its normal force. As indices of Layout::runs and of
/// links of these.
struct Pressing {
  std::size_t run = 0;
  std::size_t link = 0;
  std::size_t by_run = 0;
  std::size_t by_link = 0;
  bool is_tangent = false;  ///< both in one plane or space: slip is across the contact
};

/// A connection: its slots follow one another.
struct PlacePoint {
  int slot = 0;
  int dimensions = 1;
  int coordinate = 0;                 ///< first of its own among those of all places
  int section = 0;                    ///< of the grid
  int stride = 0;                     ///< of the modules around it
  int connection = 0;                 ///< index in Scene::connections
  std::array<int, 2> guides{-1, -1};  ///< slots of what leads along and across
};

/// A tap: its slots follow one another. Its modules are taken in the order of their slots, so that
/// those that lie side by side are summed together.
struct TapPoint {
  struct Span {
    int first = 0;  ///< slot of the x coordinate
    int count = 0;
  };
  int mat = 0;
  int slot = -1;          ///< -1: nothing but the picture asks where it is
  bool is_place = false;  ///< of a scene's place that stays, not one of its taps
  int dimensions = 1;
  int section = 0;
  int stride = 0;       ///< of the modules
  double offset = 0.0;  ///< offset of x, where its modules are at rest
  std::vector<Span> spans;
  std::vector<double> weights;  ///< of all spans, one after the other
};

/// Calls `visit(slot of the x coordinate, weight)` for the modules of a tap.
template <class Visit>
void forEachShare(const TapPoint& tap, const Visit& visit) {
  std::size_t w = 0;
  for (const TapPoint::Span& span : tap.spans) {
    for (int i = 0; i < span.count; ++i, ++w) {
      visit(span.first + i, tap.weights[w]);
    }
  }
}

/// A module seen in the frame of a section with fewer coordinates: y = axes x.
struct ProjectedPoint {
  int slot = 0;
  int dimensions = 1;         ///< coordinates of the projection
  End of;                     ///< the module that is projected
  int source_dimensions = 1;  ///< coordinates of `of`
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// A slice as a faster section sees it interpolated: its slots follow one another.
struct InterpolatedSlice {
  int slot = 0;
  int dimensions = 1;
  int coordinate = 0;  ///< first of its own among those of all interpolated slices
  int section = 0;     ///< section whose steps it follows
  End of;              ///< the slice
  std::vector<InterpolationStep> steps;  ///< of a tick
};

/// Coordinates of all of these points.
template <class Point>
std::size_t coordinatesOf(const std::vector<Point>& points) {
  return points.empty()
             ? 0
             : static_cast<std::size_t>(points.back().coordinate + points.back().dimensions);
}

struct Pickup {
  scene::Quantity quantity = scene::Quantity::kPosition;
  int slot = 0;
  int next = -1;
  double fraction = 0.0;
  double rest = 0.0;      ///< added to displacements, m
  double velocity = 1.0;  ///< from step difference to m/time_unit
  int divisor = 1;        ///< of the module's section
  int channel = 0;
  int radiation = -1;  ///< index of its high pass, -1: none
  double pole = 0.0;   ///< of that, y = (1 + pole)/2 (1 - 1/z)/(1 - pole/z) x
};

struct Feed {
  scene::Quantity quantity = scene::Quantity::kForce;
  int slot = 0;
  double rest = 0.0;
  int section = 0;
  double share = 1.0;  ///< 1 / divisor: forces on slow modules are averaged
  int channel = 0;
};

/// A link, a module or a place on a grid whose coefficients follow an audio input.
struct Follower {
  static constexpr int kModule = -1;
  static constexpr int kPlace = -2;
  int run = 0;    ///< index in Layout::runs, kModule or kPlace
  int index = 0;  ///< index of the link in its run, slot of the module, or index in Layout::places
  int section = 0;
};

/// A coordinate of a held module as one group sees it. It has a slot of its own, so that no two
/// groups write to one place: its position comes before the group is stepped, its force goes to the
/// module after all groups were.
struct Proxy {
  int slot = 0;
  int of = 0;  ///< slot of the module or point
};

/// Slots and indices of all parts of a scene in the arrays of an instrument.
struct Layout {
  std::vector<int> slot_of_mat;  ///< slot of the x coordinate; -1: a tap that is only displayed
  std::vector<int> mat_of_slot;  ///< -1: internal point
  std::vector<int> component;    ///< [slots] 0 x, 1 y, 2 z
  std::vector<SectionRange> sections;
  std::vector<Block> blocks;        ///< by section, then by slot
  std::vector<TapPoint> taps;       ///< taps that something acts on or that outputs read
  std::vector<TapPoint> seen_taps;  ///< the others, by module: they have no slots
  std::vector<PlacePoint> places;
  std::vector<InterpolatedSlice> interpolated;
  std::vector<ProjectedPoint> projections;
  std::vector<LinkRun> runs;
  std::vector<Pressing> pressings;
  std::vector<int> port_slots;  ///< [ports] slot of the coordinate that it moves
  std::vector<Pickup> pickups;
  std::vector<Feed> feeds;
  std::vector<Follower> followers;
  std::vector<int> group_of_section;        ///< [sections] index of the group that steps it
  std::vector<std::vector<Proxy>> proxies;  ///< [groups that run]
  int first_proxy = 0;                      ///< slot; from here on there are proxies and gaps
  int radiations = 0;                       ///< pickups with a high pass

  int slots() const { return static_cast<int>(mat_of_slot.size()); }
  int strideOf(const scene::Scene& scene, int mat) const;

  /// True if a section moves in frame `now`.
  bool isDue(int section, std::int64_t now) const noexcept {
    const int divisor = divisorOf(section);
    return divisor == 1 || now % divisor == 0;
  }
  /// Index of the block that a slot is in, -1: none.
  int blockOf(int slot) const noexcept {
    const auto past = std::upper_bound(blocks.begin(), blocks.end(), slot,
                                       [](int s, const Block& block) { return s < block.first; });
    return past != blocks.begin() && slot < (past - 1)->first + (past - 1)->elements
               ? static_cast<int>(past - blocks.begin()) - 1
               : -1;
  }

  /// True if the step of a run that began with frame `now` is the last in that of its slower end.
  bool endsSlowStep(const LinkRun& run, std::int64_t now) const noexcept {
    return run.slow_section >= 0 &&
           (now + divisorOf(run.section)) % divisorOf(run.slow_section) == 0;
  }
  /// True if at the start of frame `now` that last step is behind, and the next one is to come.
  /// Energy-stable runs give their force with the last frame of a step, others with the first.
  bool isBetweenSlowSteps(const LinkRun& run, std::int64_t now) const noexcept {
    const int step = run.energy_stable ? 1 : divisorOf(run.section);
    return run.slow_section < 0 || (now + step - 1) % divisorOf(run.slow_section) < step;
  }

 private:
  int divisorOf(int section) const noexcept {
    return sections[static_cast<std::size_t>(section)].divisor;
  }
};

/// Places everything, decides what is stepped together, and gives proxies to what groups see of
/// held modules. Realtime: no
/// \throws Exception if links join sections whose divisors do not divide one another
Layout makeLayout(const scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
