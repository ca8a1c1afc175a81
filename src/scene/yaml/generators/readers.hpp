// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/yaml/yaml_elements.hpp"

namespace ergotic::scene {

class PointFiles;
class YamlTables;

/// Reads one generator and adds what it makes. \throws TextError with the place of what is wrong
void readString(SceneBuilder& builder, const std::string& name, const YamlMap& map);
void readMesh(SceneBuilder& builder, const std::string& name, const YamlMap& map);
void readChaplet(SceneBuilder& builder, const std::string& name, const YamlMap& map);
void readBar(SceneBuilder& builder, const std::string& name, const YamlMap& map);
void readMembrane(SceneBuilder& builder, const std::string& name, const YamlMap& map);
void readPlate(SceneBuilder& builder, const std::string& name, const YamlMap& map);
void readResonator(SceneBuilder& builder,
                   const std::string& name,
                   const YamlMap& map,
                   PointFiles& files);
void readFrets(SceneBuilder& builder, const std::string& name, const YamlMap& map);
void readBarrier(SceneBuilder& builder,
                 const std::string& name,
                 const YamlMap& map,
                 YamlTables& tables);
/// Reads what a string ends on, its key `ends`. \pre all bodies are there
void readEnds(SceneBuilder& builder, const std::string& name, const YamlMap& map);
void readBridge(SceneBuilder& builder, const std::string& name, const YamlMap& map);

}  // namespace ergotic::scene
