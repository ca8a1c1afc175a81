// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_graph.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <utility>

#include "rviz/model_touch.hpp"

namespace ergotic::panel {
namespace {

constexpr std::size_t kMaxDimensions = 3;
constexpr float kDetour = 1.001F;  // of a way over a module that lies on the straight line
constexpr float kAskew = 0.05F;    // of two links that are about parallel and of one length
constexpr std::size_t kMaxNeighbours = 16;  // of a module of a body; a hub has more
const std::string kOutlineWord = ".outline.";

bool allBelow(const ModuleIndices& indices, std::size_t limit) {
  return std::all_of(indices.begin(), indices.end(),
                     [limit](std::uint32_t index) { return index < limit; });
}

bool haveSectionsFrames(const ModelStructure& structure) {
  const auto& dimensions = structure.section_dimensions;
  return dimensions.size() == structure.section_poses.size() &&
         std::all_of(dimensions.begin(), dimensions.end(), [](std::uint8_t dimension) {
           return dimension >= 1 && dimension <= kMaxDimensions;
         });
}

bool areStringsInside(const ModelStructure& structure) {
  const std::size_t strings = structure.string_first.size();
  if (structure.string_count.size() != strings) {
    return false;
  }
  for (std::size_t s = 0; s < strings; ++s) {
    const std::size_t end = std::size_t{structure.string_first[s]} + structure.string_count[s];
    if (end > structure.module_sections.size()) {
      return false;
    }
  }
  return true;
}

bool endsInNumber(const std::string& name, std::size_t from) {
  return from < name.size() &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(from), name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Length of the name of the body on whose outline a module of this name lies; npos: on none.
std::size_t outlineStem(const std::string& name) {
  const std::size_t at = name.rfind(kOutlineWord);
  const bool is_place = at != std::string::npos && endsInNumber(name, at + kOutlineWord.size());
  return is_place ? at : std::string::npos;
}

}  // namespace

bool isConsistent(const ModelStructure& structure) {
  const std::size_t modules = structure.module_sections.size();
  return haveSectionsFrames(structure) && structure.module_names.size() == modules &&
         structure.module_types.size() == modules &&
         structure.rest_positions.size() == kMaxDimensions * modules &&
         structure.links.size() % 2 == 0 && allBelow(structure.links, modules) &&
         allBelow(structure.module_sections, structure.section_poses.size()) &&
         areStringsInside(structure);
}

std::vector<bool> placesOfOutlines(const ModelStructure& structure) {
  std::vector<bool> places;
  for (std::size_t i = 0; i < structure.module_names.size(); ++i) {
    places.push_back(structure.module_types[i] == ModelStructure::POINT &&
                     outlineStem(structure.module_names[i]) != std::string::npos);
  }
  return places;
}

std::vector<bool> modesOfOutlines(const ModelStructure& structure) {
  if (structure.module_types.size() != structure.module_names.size()) {
    return {};
  }
  std::set<std::string> bodies;
  for (const std::string& name : structure.module_names) {
    if (const std::size_t stem = outlineStem(name); stem != std::string::npos) {
      bodies.insert(name.substr(0, stem));
    }
  }
  std::vector<bool> modes(structure.module_names.size());
  for (std::size_t i = 0; i < modes.size() && !bodies.empty(); ++i) {
    const std::string& name = structure.module_names[i];
    const std::size_t dot = name.rfind('.');
    modes[i] = structure.module_types[i] == ModelStructure::CELL && dot != std::string::npos &&
               endsInNumber(name, dot + 1) && bodies.count(name.substr(0, dot)) != 0;
  }
  return modes;
}

Eigen::Vector3f restOf(const ModelStructure& structure, std::size_t module) {
  return Eigen::Map<const Eigen::Vector3f>(&structure.rest_positions[kMaxDimensions * module]);
}

LinkGraph::LinkGraph(const ModelStructure& structure, const std::function<bool(std::size_t)>& joins)
    : neighbours_(structure.module_sections.size()), is_bridged_(neighbours_.size()) {
  const std::vector<Touch> touches = touchesOf(structure);
  for (std::size_t link = 0; link < touches.size(); ++link) {
    const std::uint32_t a = structure.links[2 * link];
    const std::uint32_t b = structure.links[2 * link + 1];
    if (touches[link] == Touch::kNone && a != b &&
        structure.module_sections[a] == structure.module_sections[b] && joins(a) && joins(b) &&
        restOf(structure, a) != restOf(structure, b)) {
      neighbours_[a].push_back(b);
      neighbours_[b].push_back(a);
    }
  }
  sortOut();
  dropBridges(structure);
  joinRims(structure);
  sortOut();
}

/// Sorts the lists: each neighbour once, and none of a hub.
void LinkGraph::sortOut() {
  for (ModuleIndices& list : neighbours_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    if (list.size() > kMaxNeighbours) {
      list.clear();
    }
  }
}

/// Links two grounds that lie beside each other like two neighbouring modules that they hold.
void LinkGraph::joinRims(const ModelStructure& structure) {
  const auto isGround = [&](std::uint32_t i) {
    return structure.module_types[i] == ModelStructure::GROUND;
  };
  ModuleIndices pairs;
  for (std::uint32_t b = 0; b < neighbours_.size(); ++b) {
    for (const std::uint32_t c : neighbours_[b]) {
      const Eigen::Vector3f way = restOf(structure, c) - restOf(structure, b);
      for (const std::uint32_t g : neighbours_[b]) {
        for (std::size_t k = 0; k < neighbours_[c].size() && isGround(g); ++k) {
          const std::uint32_t h = neighbours_[c][k];
          const Eigen::Vector3f other = restOf(structure, h) - restOf(structure, g);
          if (g != h && isGround(h) && (other - way).norm() < kAskew * way.norm()) {
            pairs.insert(pairs.end(), {g, h});
          }
        }
      }
    }
  }
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    neighbours_[pairs[i]].push_back(pairs[i + 1]);
    neighbours_[pairs[i + 1]].push_back(pairs[i]);
  }
}

bool LinkGraph::areNeighbours(std::uint32_t a, std::uint32_t b) const {
  return std::binary_search(neighbours_[a].begin(), neighbours_[a].end(), b);
}

void LinkGraph::dropBridges(const ModelStructure& structure) {
  const auto distance = [&](std::size_t a, std::size_t b) {
    return (restOf(structure, a) - restOf(structure, b)).norm();
  };
  std::vector<ModuleIndices> kept(neighbours_.size());
  for (std::size_t a = 0; a < neighbours_.size(); ++a) {
    for (const std::uint32_t b : neighbours_[a]) {
      const float length = distance(a, b);
      const auto between =
          std::find_if(neighbours_[a].begin(), neighbours_[a].end(), [&](std::uint32_t c) {
            return c != b && areNeighbours(c, b) &&
                   distance(a, c) + distance(c, b) < kDetour * length;
          });
      if (between != neighbours_[a].end()) {
        is_bridged_[*between] = true;
      } else if (areNeighbours(b, static_cast<std::uint32_t>(a))) {
        kept[a].push_back(b);
      }
    }
  }
  neighbours_ = std::move(kept);
}

}  // namespace ergotic::panel
