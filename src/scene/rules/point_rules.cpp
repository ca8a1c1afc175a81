// SPDX-License-Identifier: BSD-3-Clause
#include "scene/rules/point_rules.hpp"

#include <algorithm>
#include <unordered_set>
#include <vector>

#include "scene/limits.hpp"
#include "scene/names.hpp"

namespace ergotic::scene {
namespace {

const Mat& matAt(const Scene& scene, int mat) {
  return scene.mats[static_cast<std::size_t>(mat)];
}

bool isModule(const Scene& scene, int mat) {
  return mat >= 0 && static_cast<std::size_t>(mat) < scene.mats.size();
}

std::optional<Fault> faultOf(const Scene& scene, const Tap& tap) {
  if (!isModule(scene, tap.mat) || matAt(scene, tap.mat).type != MatType::kPoint) {
    return Fault{tap.place, "a tap is no point"};
  }
  const std::string who = "tap " + quoted(matAt(scene, tap.mat).name) + " ";
  std::unordered_set<int> known;
  bool counts = false;
  for (const Tap::Share& share : tap.shares) {
    if (!isModule(scene, share.mat)) {
      return Fault{tap.place, who + "lies on module " + std::to_string(share.mat) + ", there are " +
                                  std::to_string(scene.mats.size())};
    }
    const std::string reason = reasonAgainstTap(scene, matAt(scene, tap.mat).section, share.mat);
    if (!reason.empty()) {
      return Fault{tap.place, who + reason};
    }
    if (!known.insert(share.mat).second) {
      return Fault{tap.place, who + "lies on module " + quoted(matAt(scene, share.mat).name) +
                                  " twice, allowed: once"};
    }
    if (!kWeightLimits.hold(share.weight)) {
      return Fault{tap.place, outOfRange("a weight of " + who, share.weight, kWeightLimits, false)};
    }
    counts = counts || share.weight != 0.0;
  }
  if (!counts) {
    return Fault{tap.place, who + "has no weight other than 0, allowed: one at least"};
  }
  return std::nullopt;
}

}  // namespace

std::string reasonAgainstTap(const Scene& scene, int section, int mat) {
  const Mat& m = matAt(scene, mat);
  if (m.type != MatType::kMass && m.type != MatType::kCell && m.type != MatType::kGround) {
    return "lies on " + quoted(m.name) + ", allowed: masses, cells and grounds";
  }
  if (m.section != section) {
    return "lies on " + quoted(m.name) + " of section " + quoted(scene.sectionOf(m).name) +
           ", allowed: modules of one section, here " +
           quoted(scene.sections[static_cast<std::size_t>(section)].name);
  }
  return {};
}

std::optional<Fault> misplacedPoint(const Scene& scene) {
  std::vector<int> found(scene.mats.size(), 0);
  for (const Connection& connection : scene.connections) {
    ++found[static_cast<std::size_t>(connection.mat)];
  }
  for (const Tap& tap : scene.taps) {
    if (const std::optional<Fault> fault = faultOf(scene, tap)) {
      return fault;
    }
    ++found[static_cast<std::size_t>(tap.mat)];
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Mat& m = scene.mats[i];
    if (m.type == MatType::kPoint && found[i] != 1) {
      return Fault{m.place, "point " + quoted(m.name) + " has " + std::to_string(found[i]) +
                                " connections or taps, allowed: 1"};
    }
  }
  return std::nullopt;
}

}  // namespace ergotic::scene
