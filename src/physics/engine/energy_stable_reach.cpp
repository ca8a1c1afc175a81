// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/energy_stable_reach.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "at.hpp"
#include "ergotic/scene/grid.hpp"

namespace ergotic::physics {
namespace {

constexpr double kIndependent = 1e-9;  // of how far two taps move each other

template <class Points>
std::vector<int> indicesBySlot(const Layout& layout, const Points& points) {
  std::vector<int> indices(at(layout.slots()), -1);
  for (std::size_t p = 0; p < points.size(); ++p) {
    indices[at(points[p].slot)] = static_cast<int>(p);
  }
  return indices;
}

/// How far a force on a module moves it; NaN if that changes with a parameter.
double mobilityOf(const scene::Mat& mat) {
  const bool is_free = mat.type == scene::MatType::kMass || mat.type == scene::MatType::kCell;
  const double mobility = mat.mass.parameter < 0 ? 1.0 / mat.mass.factor : std::nan("");
  return is_free ? mobility : 0.0;
}

/// Whether forces on one of two taps move the other: those with modules in common, unless what
/// these do cancels.
class Coupling {
 public:
  Coupling(const scene::Scene& scene, const Layout& layout)
      : layout_(layout), mobility_(at(layout.slots()), 0.0), weight_(mobility_) {
    for (int slot = 0; slot < layout.slots(); ++slot) {
      const int mat = layout.mat_of_slot[at(slot)];
      mobility_[at(slot)] = mat < 0 ? 0.0 : mobilityOf(scene.mats[at(mat)]);
    }
  }

  bool moves(int slot) const { return mobility_[at(slot)] != 0.0; }

  bool isBetween(int one, int other) {
    const TapPoint& a = layout_.taps[at(one)];
    const TapPoint& b = layout_.taps[at(other)];
    double own_a = 0.0;
    double own_b = 0.0;
    double both = 0.0;
    forEachShare(a, [&](int slot, double weight) {
      weight_[at(slot)] = weight;
      own_a += weight * weight * mobility_[at(slot)];
    });
    forEachShare(b, [&](int slot, double weight) {
      const double common = weight * weight_[at(slot)];
      own_b += weight * weight * mobility_[at(slot)];
      both += common == 0.0 ? 0.0 : common * mobility_[at(slot)];
    });
    forEachShare(a, [&](int slot, double) { weight_[at(slot)] = 0.0; });
    return both != 0.0 && !(std::abs(both) <= kIndependent * std::sqrt(own_a * own_b));
  }

 private:
  const Layout& layout_;
  std::vector<double> mobility_;  // [slots]
  std::vector<double> weight_;    // [slots]
};

}  // namespace

EnergyStableReach::EnergyStableReach(const scene::Scene& scene,
                                     const Layout& layout,
                                     const std::vector<EnergyStableGroup>& groups)
    : layout_(layout),
      place_of_slot_(indicesBySlot(layout, layout.places)),
      projection_of_slot_(indicesBySlot(layout, layout.projections)),
      tap_of_slot_(indicesBySlot(layout, layout.taps)),
      is_whole_(layout.taps.size(), 1) {
  for (const scene::Mat& mat : scene.mats) {
    rests_.push_back(mat.rest);
  }
  for (const PlacePoint& point : layout.places) {
    grids_.push_back(scene.grids[at(scene.connections[at(point.connection)].grid)]);
  }
  findWholeTaps(scene, groups);
}

int EnergyStableReach::behind(int slot) const noexcept {
  const int projection = projection_of_slot_[at(slot)];
  return projection >= 0 ? behind(layout_.projections[at(projection)].of.slot) : slot;
}

std::vector<int> EnergyStableReach::slotsUnder(std::size_t place) const {
  const scene::Grid& grid = grids_[place];
  const auto first = layout_.slot_of_mat.begin() + grid.first;
  return {first, first + grid.columns * grid.rows};
}

void EnergyStableReach::findWholeTaps(const scene::Scene& scene,
                                      const std::vector<EnergyStableGroup>& groups) {
  std::set<int> taps;
  std::set<int> modules;
  for (const EnergyStableGroup& group : groups) {
    for (const EnergyStableRef& ref : group.links) {
      const LinkEnds& ends = layout_.runs[ref.run].ends[ref.link];
      for (const int slot : {behind(ends.a), behind(ends.b)}) {
        if (tap_of_slot_[at(slot)] >= 0) {
          taps.insert(tap_of_slot_[at(slot)]);
        } else if (const int place = place_of_slot_[at(slot)]; place >= 0) {
          const std::vector<int> under = slotsUnder(at(place));
          modules.insert(under.begin(), under.end());
        } else {
          modules.insert(slot);
        }
      }
    }
  }
  if (taps.empty()) {
    return;
  }
  Coupling coupling(scene, layout_);
  for (const int tap : taps) {
    forEachShare(layout_.taps[at(tap)], [&](int slot, double weight) {
      if (weight != 0.0 && coupling.moves(slot) && modules.count(slot) != 0) {
        is_whole_[at(tap)] = 0;
      }
    });
    for (const int other : taps) {
      if (other < tap && coupling.isBetween(tap, other)) {
        is_whole_[at(tap)] = is_whole_[at(other)] = 0;
      }
    }
  }
}

bool EnergyStableReach::mayBeLed(const EnergyStableRef& ref) const {
  const LinkEnds& ends = layout_.runs[ref.run].ends[ref.link];
  const auto isLed = [this](int slot) {
    for (const std::vector<Proxy>& proxies : layout_.proxies) {
      for (const Proxy& proxy : proxies) {
        if (proxy.slot == slot) {
          slot = proxy.of;
        }
      }
    }
    return place_of_slot_[at(behind(slot))] >= 0;
  };
  return isLed(ends.a) || isLed(ends.b);
}

std::array<int, 2> EnergyStableReach::placesOf(const EnergyStableRef& ref) const noexcept {
  const LinkEnds& ends = layout_.runs[ref.run].ends[ref.link];
  return {place_of_slot_[at(behind(ends.a))], place_of_slot_[at(behind(ends.b))]};
}

std::vector<std::size_t> EnergyStableReach::tapsAt(const EnergyStableRef& ref) const {
  std::vector<std::size_t> taps;
  const LinkEnds& ends = layout_.runs[ref.run].ends[ref.link];
  for (const int end : {ends.a, ends.b}) {
    const int tap = tap_of_slot_[at(behind(end))];
    if (tap >= 0 && is_whole_[at(tap)] != 0) {
      taps.push_back(at(tap));
    }
  }
  return taps;
}

void EnergyStableReach::find(const EnergyStableRef& ref,
                             const double* places,
                             Terms& to) const noexcept {
  const LinkRun& run = layout_.runs[ref.run];
  const int divisor = layout_.sections[at(run.section)].divisor;
  const auto slowOf = [&](int section) {
    return layout_.sections[at(section)].divisor > divisor && !run.interpolated ? section : -1;
  };
  const int dimensions = std::max(1, run.dimensions);
  const LinkEnds& ends = run.ends[ref.link];
  const Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
  to.terms.clear();
  Eigen::Map<Eigen::Vector3d>(to.offset) = run.rests[ref.link];
  reachEnd(ends.a, run.stride_a, dimensions, map, slowOf(run.section_a), places, to);
  reachEnd(ends.b, run.stride_b, dimensions, -map, slowOf(run.section_b), places, to);
}

/// \param map  from the coordinates of the end to those of the link, signed
void EnergyStableReach::reachEnd(int slot,
                                 int stride,
                                 int dimensions,
                                 const Eigen::Matrix3d& map,
                                 int slow_section,
                                 const double* places,
                                 Terms& to) const noexcept {
  const auto add = [&](int module, int step, double weight, bool is_tap) {
    for (int c = 0; c < dimensions; ++c) {
      EnergyStableTerm term{module + c * step, module, c, {}, slow_section, is_tap};
      Eigen::Map<Eigen::Vector3d>(term.weight) = weight * map.col(c);
      to.terms.push_back(term);
    }
  };
  const int projection = projection_of_slot_[at(slot)];
  const int place = place_of_slot_[at(slot)];
  const int tap = tap_of_slot_[at(slot)];
  if (projection >= 0) {
    const ProjectedPoint& point = layout_.projections[at(projection)];
    Eigen::Matrix3d seen = Eigen::Matrix3d::Zero();
    seen.topRows(point.dimensions) = point.axes.topRows(point.dimensions);
    reachEnd(point.of.slot, point.of.stride, point.source_dimensions, map * seen, slow_section,
             places, to);
  } else if (place >= 0) {
    const PlacePoint& point = layout_.places[at(place)];
    const scene::GridPlace around =
        scene::placeOn(grids_[at(place)], places[2 * place], places[2 * place + 1]);
    const Eigen::Vector3d& rest = rests_[at(layout_.mat_of_slot[at(slot)])];
    for (int i = 0; i < around.count; ++i) {
      const double weight = around.weights[at(i)];
      add(layout_.slot_of_mat[at(around.mats[at(i)])], point.stride, weight, false);
      const Eigen::Vector3d apart = rests_[at(around.mats[at(i)])] - rest;
      for (int c = 0; c < dimensions; ++c) {
        Eigen::Map<Eigen::Vector3d>(to.offset) += weight * apart[c] * map.col(c);
      }
    }
  } else if (tap >= 0 && is_whole_[at(tap)] == 0) {
    const TapPoint& point = layout_.taps[at(tap)];
    forEachShare(point,
                 [&](int module, double weight) { add(module, point.stride, weight, false); });
    Eigen::Map<Eigen::Vector3d>(to.offset) += point.offset * map.col(0);
  } else {
    add(slot, stride, 1.0, tap >= 0);
  }
}

}  // namespace ergotic::physics
