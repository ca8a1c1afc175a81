// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <unordered_map>
#include <utility>

#include "scene/names.hpp"
#include "scene/rules/rules.hpp"

namespace ergotic::scene {
namespace {

constexpr char kAxisNames[] = {'x', 'y', 'z'};

std::string nameOfMat(const Scene& scene, int mat) {
  return quoted(scene.mats[static_cast<std::size_t>(mat)].name);
}

std::optional<Fault> movedByTwoPorts(const Scene& scene) {
  std::unordered_map<int, const Port*> by_slice;
  std::map<std::pair<int, int>, const Port*> by_coordinate;
  for (const Port& p : scene.ports) {
    const auto same_slice = by_slice.emplace(p.slice, &p);
    if (p.slice != -1 && !same_slice.second) {
      return Fault{p.place, "port " + quoted(p.name) + " is on slice " + std::to_string(p.slice) +
                                ", which port " + quoted(same_slice.first->second->name) + " has"};
    }
    const auto same = by_coordinate.emplace(std::make_pair(p.mat, p.axis), &p);
    if (!same.second) {
      return Fault{p.place, "port " + quoted(p.name) + " moves module " + nameOfMat(scene, p.mat) +
                                " along " + kAxisNames[p.axis] + ", which port " +
                                quoted(same.first->second->name) + " does"};
    }
  }
  return std::nullopt;
}

std::optional<Fault> drivenByTwoInputs(const Scene& scene) {
  std::unordered_map<int, const Input*> by_driven;
  for (const Input& in : scene.inputs) {
    if (in.quantity != Quantity::kPosition) {
      continue;
    }
    const auto same = by_driven.emplace(in.mat, &in);
    if (!same.second) {
      return Fault{in.place, "input " + quoted(in.name) + " sets the position of module " +
                                 nameOfMat(scene, in.mat) + ", which input " +
                                 quoted(same.first->second->name) + " does"};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Fault> movedTwice(const Scene& scene) {
  std::optional<Fault> fault = movedByTwoPorts(scene);
  return fault ? fault : drivenByTwoInputs(scene);
}

}  // namespace ergotic::scene
