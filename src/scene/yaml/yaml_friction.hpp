// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/yaml_map.hpp"
#include "scene/yaml/yaml_tables.hpp"

/// Keys that friction has beside its ends.
namespace ergotic::scene {

/// `normal`: a number or the name of a contact; `table`, or `steady` and `parts`.
/// \throws TextError  at the key
void readFriction(const SceneBuilder& builder, YamlTables& tables, const YamlMap& map, Lia& lia);

/// Links that another one presses, and where its name stands.
using Pressed = std::vector<std::pair<Name, Place>>;

/// \pre all links are there
/// \throws TextError  where a name is of no link, or of one that is no contact
void checkPressers(const SceneBuilder& builder, const Pressed& pressed);

}  // namespace ergotic::scene
