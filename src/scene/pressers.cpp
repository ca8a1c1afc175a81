// SPDX-License-Identifier: BSD-3-Clause
#include "scene/pressers.hpp"

#include <map>
#include <string>

namespace ergotic::scene {

std::vector<int> pressersOf(const Scene& scene) {
  std::map<std::string, int> wanted;
  for (const Lia& lia : scene.lias) {
    if (!lia.law->pressed_by.empty()) {
      wanted.emplace(lia.law->pressed_by.str(), -1);
    }
  }
  if (wanted.empty()) {
    return {};
  }
  std::vector<int> pressers(scene.lias.size(), -1);
  for (std::size_t l = 0; l < scene.lias.size(); ++l) {
    const auto found = wanted.find(scene.lias[l].name.str());
    if (found != wanted.end()) {
      found->second = static_cast<int>(l);
    }
  }
  for (std::size_t l = 0; l < scene.lias.size(); ++l) {
    const Name& name = scene.lias[l].law->pressed_by;
    pressers[l] = name.empty() ? -1 : wanted.at(name.str());
  }
  return pressers;
}

}  // namespace ergotic::scene
