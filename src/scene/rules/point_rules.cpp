// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <unordered_set>
#include <vector>

#include "at.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/rules/rules.hpp"

namespace ergotic::scene {
namespace {

bool exists(const Scene& scene, int mat) {
  return mat >= 0 && static_cast<std::size_t>(mat) < scene.mats.size();
}

std::optional<Fault> faultOfTap(const Scene& scene, const Tap& tap) {
  if (!exists(scene, tap.mat) || scene.mats[at(tap.mat)].type != MatType::kPoint) {
    return Fault{tap.place, "a tap is no point"};
  }
  const std::string who = "tap " + quoted(scene.mats[at(tap.mat)].name) + " ";
  std::unordered_set<int> known;
  bool counts = false;
  for (const Tap::Share& share : tap.shares) {
    if (!exists(scene, share.mat)) {
      return Fault{tap.place, who + "lies on module " + std::to_string(share.mat) + ", there are " +
                                  std::to_string(scene.mats.size())};
    }
    const std::string reason = reasonAgainstTap(scene, scene.mats[at(tap.mat)].section, share.mat);
    if (!reason.empty()) {
      return Fault{tap.place, who + reason};
    }
    if (!known.insert(share.mat).second) {
      return Fault{tap.place, who + "lies on module " + quoted(scene.mats[at(share.mat)].name) +
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
  const Mat& m = scene.mats[at(mat)];
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
    if (std::optional<Fault> fault = faultOfTap(scene, tap)) {
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
