// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_players.hpp"

#include <algorithm>
#include <set>

#include "rviz/model_shape.hpp"

namespace ergotic::panel {
namespace {

bool isNumber(const std::string& word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
}

/// The last word of a name with dots, which it loses.
std::string takeLast(std::string& name) {
  const std::size_t dot = name.rfind('.');
  std::string last = dot == std::string::npos ? "" : name.substr(dot + 1);
  name.resize(std::min(name.size(), dot));
  return last;
}

bool isOfBody(ModuleLook look) {
  return look == ModuleLook::kString || look == ModuleLook::kBar || look == ModuleLook::kSurface ||
         look == ModuleLook::kPoint;
}

class PlayerFinder {
 public:
  explicit PlayerFinder(const ModelStructure& structure)
      : structure_(structure),
        looks_(shapeOf(structure).looks),
        ends_(structure.module_names.size()) {
    for (std::size_t link = 0; link + 1 < structure.links.size(); link += 2) {
      const std::uint32_t a = structure.links[link];
      const std::uint32_t b = structure.links[link + 1];
      ends_[a].push_back(b);
      ends_[b].push_back(a);
    }
  }

  std::vector<std::string> playedBy(std::uint32_t hand) const {
    std::set<std::string> bodies;
    std::set<std::uint32_t> seen = {hand};
    std::vector<std::uint32_t> open = {hand};
    while (!open.empty()) {
      const std::uint32_t module = open.back();
      open.pop_back();
      for (const std::uint32_t other : ends_[module]) {
        if (!seen.insert(other).second) {
          continue;
        }
        if (isOfBody(looks_[other])) {
          bodies.insert(bodyOf(structure_.module_names[other]));
        } else if (structure_.module_types[other] != ModelStructure::SLICE &&
                   structure_.module_types[other] != ModelStructure::GROUND) {
          open.push_back(other);
        }
      }
    }
    return {bodies.begin(), bodies.end()};
  }

 private:
  const ModelStructure& structure_;
  std::vector<ModuleLook> looks_;
  std::vector<std::vector<std::uint32_t>> ends_;  // [modules] at the other ends of their links
};

}  // namespace

std::string bodyOf(const std::string& module) {
  std::string name = module;
  if (const std::size_t at = name.find('@'); at != std::string::npos) {
    name.resize(at);
    return name;
  }
  std::string rest = name;
  std::string last = takeLast(rest);
  const bool is_counted = isNumber(last);
  while (isNumber(last)) {
    name = rest;
    last = takeLast(rest);
  }
  return !last.empty() && (!is_counted || last == "outline") ? rest : name;
}

std::vector<std::vector<std::string>> playedBy(const ModelStructure& structure,
                                               const std::vector<std::uint32_t>& hands) {
  const PlayerFinder finder(structure);
  std::vector<std::vector<std::string>> played;
  for (const std::uint32_t hand : hands) {
    played.push_back(finder.playedBy(hand));
  }
  return played;
}

}  // namespace ergotic::panel
