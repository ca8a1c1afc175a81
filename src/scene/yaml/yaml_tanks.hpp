// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/yaml_map.hpp"

/// Links that share an energy tank: `tank: NAME` of cubic ones, and `type: stretch`.
namespace ergotic::scene {

/// A stretch, and what it is of: generated strings and meshes, or links. They are looked for when
/// all links are there.
struct StretchKeys {
  Tank tank;
  bool is_list = false;  ///< only a list can name links
  std::vector<std::pair<std::string, Place>> names;
};

StretchKeys readStretch(const SceneBuilder& builder, const std::string& name, const YamlMap& map);
/// \throws TextError if a spring is not there
void addStretch(SceneBuilder& builder, StretchKeys stretch);

/// The tank that a link names; the first that names it makes it.
void readTank(SceneBuilder& builder, const YamlMap& map, Lia& lia);

}  // namespace ergotic::scene
