// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include <Eigen/Core>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/yaml_map.hpp"

/// The parts of a YAML scene. Each is given the whole top-level map and reads its own key, in this
/// order, because later parts name what earlier ones define. All throw TextError.
namespace ergotic::scene {

class PointFiles;
class YamlTables;

/// `about`: title, author, licence, ... \throws TextError
About readAbout(const SceneBuilder& builder, const YamlMap& top);
void readSections(SceneBuilder& builder, const YamlMap& top);
void readMats(SceneBuilder& builder, const YamlMap& top);  ///< reads all modules but the points
void readGenerators(SceneBuilder& builder,
                    const YamlMap& top,
                    YamlTables& tables,
                    PointFiles& files);
void readPoints(SceneBuilder& builder, const YamlMap& top);  ///< of `mats`: they lie on grids
void readLias(SceneBuilder& builder, const YamlMap& top, YamlTables& tables);
/// A module that lies on a grid, `type: point`.
void readPoint(SceneBuilder& builder, const std::string& name, const YamlMap& map);
/// A link of many ends, `type: bend`.
void readBend(SceneBuilder& builder, const std::string& name, const YamlMap& map);
/// Reads the relaxations of a link. \pre its stiffness is read
void readRelaxations(const SceneBuilder& builder, const YamlMap& map, Lia& lia);
void readPorts(SceneBuilder& builder, const YamlMap& top);
void readAgents(SceneBuilder& builder, const YamlMap& top, PointFiles& files);
void readPortFilters(SceneBuilder& builder, const YamlMap& top);  ///< when all links are there
void readInputs(SceneBuilder& builder, const YamlMap& top);
void readOutputs(SceneBuilder& builder, const YamlMap& top);

/// Reads one of these words, for position, force, velocity, in this order.
Quantity readQuantity(const YamlMap& map, const std::vector<std::string>& words);

/// Calls `element` with the map under every name of a part, or with every row of the table there;
/// nothing if the part is missing.
/// \param kind  of the elements, for messages
using ElementReader = std::function<void(const std::string& name, const YamlMap& map)>;
void forEachElement(const SceneBuilder& builder,
                    const YamlMap& top,
                    const std::string& part,
                    const std::string& kind,
                    const ElementReader& element);

/// Index of the section under the key `section`, or of the only one.
int sectionOf(const SceneBuilder& builder, const YamlMap& map);

/// A rest place, m; zeros if the key is missing. Scalar sections: `[y, z]` on the workbench. The
/// others: the coordinates that move, and those of the workbench after them if they are given.
Eigen::Vector3d readRest(const Section& section, const YamlMap& map, const std::string& key);

/// Reads as many numbers as the section has coordinates that move (one need not be a list).
Eigen::Vector3d readMoving(const Section& section,
                           const YamlMap& map,
                           const std::string& key,
                           const Limits& limits,
                           const Eigen::Vector3d& otherwise);

/// The coordinate under the key `axis`, one that moves in the section of the module; x if the key
/// is missing.
int readAxis(const SceneBuilder& builder, const YamlMap& map, int mat);

/// \throws TextError if a key is given that has no meaning in the geometry of the section
void refuseIn(const SceneBuilder& builder,
              const Section& section,
              const YamlMap& map,
              const std::vector<std::string>& keys,
              const std::string& allowed);

}  // namespace ergotic::scene
