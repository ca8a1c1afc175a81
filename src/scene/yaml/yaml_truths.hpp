// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/scene/truth.hpp"
#include "scene/generate/scene_builder.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {

/// Claims of a scene about itself; none without the key `truths`.
/// \pre all other parts are read \throws TextError
std::vector<Truth> truthsOf(const SceneBuilder& builder, const YamlMap& top);

}  // namespace ergotic::scene
