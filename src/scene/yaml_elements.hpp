// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/scene_builder.hpp"
#include "scene/yaml_map.hpp"

/// The parts of a YAML scene. Each is given the whole top-level map and reads its own key, in this
/// order, because later parts name what earlier ones define. All throw TextError.
namespace ergotic::scene {

void readMats(SceneBuilder& builder, const YamlMap& top);
void readGenerators(SceneBuilder& builder, const YamlMap& top);
void readLias(SceneBuilder& builder, const YamlMap& top);
void readPorts(SceneBuilder& builder, const YamlMap& top);
void readInputs(SceneBuilder& builder, const YamlMap& top);
void readOutputs(SceneBuilder& builder, const YamlMap& top);

/// Calls `element` with the map under every name of a part; nothing if the part is missing.
/// \param kind  of the elements, for messages
using ElementReader = std::function<void(const std::string& name, const YamlMap& map)>;
void forEachElement(const SceneBuilder& builder,
                    const YamlMap& top,
                    const std::string& part,
                    const std::string& kind,
                    const ElementReader& element);

}  // namespace ergotic::scene
