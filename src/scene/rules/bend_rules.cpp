// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scene/laws/range.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/rules/rules.hpp"

namespace ergotic::scene {
namespace {

constexpr double kMaxWeight = 8.0;

const Mat& endMat(const Scene& scene, const Bend::End& end) {
  return scene.mats[static_cast<std::size_t>(end.mat)];
}

Geometry geometryOf(const Scene& scene, const Bend& bend) {
  return scene.sectionOf(endMat(scene, bend.ends.front())).geometry;
}

std::string numberFault(const Scene& scene, const Bend& bend) {
  const struct {
    const char* name;
    Range range;
    Limits limits;
  } numbers[] = {
      {"stiffness", rangeOf(scene, bend.stiffness), kStiffnessLimits},
      {"damping", rangeOf(scene, bend.damping), kDampingLimits},
      {"rest_length", {bend.rest_length, bend.rest_length}, kMetreLimits},
  };
  for (const auto& number : numbers) {
    for (const double end : {number.range.lowest, number.range.highest}) {
      if (!number.limits.hold(end)) {
        return outOfRange(number.name + (" of link " + quoted(bend.name)), end, number.limits);
      }
    }
  }
  return {};
}

std::string faultOf(const Scene& scene, const Bend& bend) {
  const auto is_there = [&](const Bend::End& end) {
    return end.mat >= 0 && static_cast<std::size_t>(end.mat) < scene.mats.size();
  };
  if (!std::all_of(bend.ends.begin(), bend.ends.end(), is_there)) {
    return "an end of link " + quoted(bend.name) + " does not exist, there are " +
           std::to_string(scene.mats.size()) + " modules";
  }
  for (const std::string& fault : {endsFault(scene, bend), weightsFault(bend)}) {
    if (!fault.empty()) {
      return fault;
    }
  }
  for (const std::string& fault :
       {numberFault(scene, bend), dampingFault(scene, bend), restFault(scene, bend)}) {
    if (!fault.empty()) {
      return fault;
    }
  }
  return {};
}

}  // namespace

std::string endsFault(const Scene& scene, const Bend& bend) {
  const std::string link = "link " + quoted(bend.name);
  if (bend.ends.size() < kFewestBendEnds || bend.ends.size() > kMaxBendEnds) {
    return link + " has " + std::to_string(bend.ends.size()) + " ends, allowed: 3...5";
  }
  for (auto end = bend.ends.begin(); end != bend.ends.end(); ++end) {
    const Mat& mat = endMat(scene, *end);
    if (!isModule(mat) || mat.section != endMat(scene, bend.ends.front()).section) {
      return link + " ends on module " + quoted(mat.name) +
             ", allowed: masses, cells and grounds of one section";
    }
    const auto is_same = [&](const Bend::End& other) { return other.mat == end->mat; };
    if (std::any_of(bend.ends.begin(), end, is_same)) {
      return link + " ends on module " + quoted(mat.name) + " twice, allowed: once";
    }
  }
  return {};
}

std::string weightsFault(const Bend& bend) {
  double sum = 0.0;
  for (const Bend::End& end : bend.ends) {
    const bool is_whole = std::abs(end.weight) <= kMaxWeight && std::rint(end.weight) == end.weight;
    if (!is_whole || end.weight == 0.0) {
      return "a weight of link " + quoted(bend.name) + " is " + numberText(end.weight) +
             ", allowed: whole numbers from -8 to 8 but 0";
    }
    sum += end.weight;
  }
  return sum == 0.0 ? ""
                    : "weights of link " + quoted(bend.name) + " add up to " + numberText(sum) +
                          ", allowed: 0, so that moving all ends alike takes no force";
}

std::string dampingFault(const Scene& scene, const Bend& bend) {
  const bool is_flat = dimensionsOf(geometryOf(scene, bend)) > 1;
  return is_flat && largest(scene, bend.damping) > 0.0
             ? "link " + quoted(bend.name) +
                   " has a damping, allowed in a plane and in space: 0 (dampers act along lines "
                   "there), and a medium, or the damping of cells"
             : "";
}

std::string restFault(const Scene& scene, const Bend& bend) {
  return bend.rest_length != 0.0 && geometryOf(scene, bend) != Geometry::kScalar
             ? "link " + quoted(bend.name) + " has a rest_length, allowed: in scalar sections"
             : "";
}

std::optional<Fault> wrongBend(const Scene& scene) {
  for (const Bend& bend : scene.bends) {
    if (const std::string fault = faultOf(scene, bend); !fault.empty()) {
      return Fault{bend.place, fault};
    }
  }
  return std::nullopt;
}

}  // namespace ergotic::scene
