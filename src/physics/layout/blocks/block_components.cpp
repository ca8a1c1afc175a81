// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/layout/blocks/block_parts.hpp"
#include "scene/laws/bend_parts.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::Mat;
using scene::MatType;

bool follows(const scene::Value& value) {
  return value.audio >= 0;
}

/// Modules that blocks can hold: free ones and grounds.
bool isFree(const Mat& mat) {
  const bool is_cell = mat.type == MatType::kCell;
  return (is_cell || mat.type == MatType::kMass) && !follows(mat.mass) &&
         !(is_cell && (follows(mat.stiffness) || follows(mat.damping)));
}

/// True for a part of a bend with a curvature at rest: beside others, such springs may add up to a
/// force without stiffness.
bool isOffsetPart(const scene::Lia& lia) {
  return lia.bend >= 0 && lia.rest_length != 0.0;
}

/// Parts of bends of unlike stiffness between the same two modules, which add up to more digits
/// than single precision has: side by side in a block they would be another spring, no part of a
/// bend, and drive what nothing holds.
class InexactSums {
 public:
  explicit InexactSums(const scene::Scene& scene) : scene_(scene) {
    for (const scene::Lia& lia : scene.lias) {
      if (lia.bend >= 0) {
        Sum& sum = sums_[std::minmax(lia.a, lia.b)];
        add(lia, lia.stiffness, sum.stiffness);
        add(lia, 2.0 * lia.damping, sum.damping);  // in steps its first digit may be another
      }
    }
  }
  bool has(const scene::Lia& lia) const {
    if (lia.bend < 0) {
      return false;
    }
    const Sum& sum = sums_.at(std::minmax(lia.a, lia.b));
    return isInexact(sum.stiffness) || isInexact(sum.damping);
  }

 private:
  struct Parts {
    int count = 0;
    double most = 0.0;                                      // of all together
    double unit = std::numeric_limits<double>::infinity();  // all are whole multiples of it
  };
  struct Sum {
    Parts stiffness;
    Parts damping;
  };

  void add(const scene::Lia& lia, const scene::Value& value, Parts& parts) const {
    const scene::Range range = scene::rangeOf(scene_, value);
    const double most = std::max(std::abs(range.lowest), std::abs(range.highest));
    if (most > 0.0) {
      const double least = std::min(std::abs(range.lowest), std::abs(range.highest));
      ++parts.count;
      parts.most += most;
      parts.unit = std::min(
          parts.unit,
          least > 0.0 ? scene::unitOf(least / std::abs(scene::multipleOf(scene_, lia))) : 0.0);
    }
  }
  static bool isInexact(const Parts& parts) {
    return parts.count > 1 &&
           !(parts.most < std::ldexp(parts.unit, std::numeric_limits<float>::digits));
  }

  const scene::Scene& scene_;
  std::map<std::pair<int, int>, Sum> sums_;
};

bool isLinear(const scene::Scene& scene, const scene::Lia& lia) {
  const Mat& a = scene.mats[at(lia.a)];
  const Mat& b = scene.mats[at(lia.b)];
  const bool a_free = isFree(a);
  const bool b_free = isFree(b);
  return lia.type == LiaType::kSpringDamper && lia.scheme == scene::Scheme::kExplicit &&
         a.section == b.section && lia.a != lia.b && !isOffsetPart(lia) &&
         scene.sectionOf(a).geometry == scene::Geometry::kScalar && !follows(lia.stiffness) &&
         !follows(lia.damping) && (a_free || b_free) && (a_free || a.type == MatType::kGround) &&
         (b_free || b.type == MatType::kGround);
}

/// The set of modules that each ground belongs to: kNone, or kShared if there are several.
class Grounds {
 public:
  static constexpr int kNone = -1;
  static constexpr int kShared = -2;
  Grounds(const scene::Scene& scene, const std::vector<int>& lias, DisjointSets& sets)
      : set_(scene.mats.size(), kNone) {
    for (const int l : lias) {
      const scene::Lia& lia = scene.lias[at(l)];
      note(scene, lia.a, lia.b, sets);
      note(scene, lia.b, lia.a, sets);
    }
  }
  int of(int mat) const { return set_[at(mat)]; }

 private:
  void note(const scene::Scene& scene, int ground, int other, DisjointSets& sets) {
    if (scene.mats[at(ground)].type == MatType::kGround) {
      int& set = set_[at(ground)];
      const int found = sets.setOf(other);
      set = set == kNone || set == found ? found : kShared;
    }
  }
  std::vector<int> set_;
};

}  // namespace

std::vector<Component> findComponents(const scene::Scene& scene) {
  std::vector<int> linear;
  const InexactSums inexact(scene);
  DisjointSets sets(scene.mats.size());
  for (int l = 0; l < static_cast<int>(scene.lias.size()); ++l) {
    const scene::Lia& lia = scene.lias[at(l)];
    if (isLinear(scene, lia) && !inexact.has(lia)) {
      linear.push_back(l);
      if (isFree(scene.mats[at(lia.a)]) && isFree(scene.mats[at(lia.b)])) {
        sets.join(lia.a, lia.b);
      }
    }
  }
  const Grounds grounds(scene, linear, sets);
  std::vector<int> component_of_set(scene.mats.size(), -1);
  std::vector<Component> components;
  const auto componentOf = [&](int set) -> Component& {
    int& index = component_of_set[at(set)];
    if (index < 0) {
      index = static_cast<int>(components.size());
      components.push_back({scene.mats[at(set)].section, {}, {}});
    }
    return components[at(index)];
  };
  for (const int l : linear) {
    const scene::Lia& lia = scene.lias[at(l)];
    if (grounds.of(lia.a) != Grounds::kShared && grounds.of(lia.b) != Grounds::kShared) {
      componentOf(sets.setOf(isFree(scene.mats[at(lia.a)]) ? lia.a : lia.b)).lias.push_back(l);
    }
  }
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    const int set = isFree(scene.mats[at(m)]) ? sets.setOf(m) : grounds.of(m);
    if (set >= 0 && component_of_set[at(set)] >= 0) {
      components[at(component_of_set[at(set)])].mats.push_back(m);
    }
  }
  return components;
}

std::vector<int> chainOrder(const scene::Scene& scene,
                            const Component& component,
                            const std::vector<int>& places) {
  const int count = static_cast<int>(component.mats.size());
  if (static_cast<int>(component.lias.size()) != count - 1) {
    return {};
  }
  std::vector<std::array<int, 2>> neighbours(at(count), {-1, -1});
  for (const int l : component.lias) {
    const scene::Lia& lia = scene.lias[at(l)];
    const int ends[2] = {places[at(lia.a)], places[at(lia.b)]};
    for (const int k : {0, 1}) {
      std::array<int, 2>& mine = neighbours[at(ends[k])];
      if (mine[1] >= 0) {
        return {};  // a third neighbour
      }
      mine[mine[0] < 0 ? 0 : 1] = ends[1 - k];
    }
  }
  int here = 0;
  while (here < count && neighbours[at(here)][1] >= 0) {
    ++here;
  }
  std::vector<int> order;
  for (int last = -1; here >= 0 && static_cast<int>(order.size()) < count;) {
    order.push_back(component.mats[at(here)]);
    const std::array<int, 2>& next = neighbours[at(here)];
    const int on = next[0] != last ? next[0] : next[1];
    last = here;
    here = on;
  }
  return static_cast<int>(order.size()) == count ? order : std::vector<int>{};
}

std::vector<OffsetCount> offsetsOf(const scene::Scene& scene,
                                   const Component& component,
                                   const std::vector<int>& places) {
  std::map<int, int> histogram;
  for (const int l : component.lias) {
    const scene::Lia& lia = scene.lias[at(l)];
    ++histogram[std::abs(places[at(lia.a)] - places[at(lia.b)])];
  }
  std::vector<OffsetCount> counts;
  for (const auto& [offset, links] : histogram) {
    counts.push_back({offset, links});
  }
  std::stable_sort(counts.begin(), counts.end(),
                   [](const OffsetCount& a, const OffsetCount& b) { return a.links > b.links; });
  return counts;
}

}  // namespace ergotic::physics
