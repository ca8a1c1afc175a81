// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/yaml_map.hpp"
#include "scene/yaml/point_files.hpp"

namespace ergotic::scene {

/// Units of the two numbers of a point.
struct TableUnits {
  const char* first = "";
  const char* second = "N";
};

/// The tables of a scene, wherever their points are: `[[x, y], ...]`, or
/// `{points: [[x, y], ...], interpolation: ...}`, or `{file: name.csv, interpolation: ...}`.
class YamlTables {
 public:
  YamlTables(SceneBuilder& builder, PointFiles& files) : builder_(builder), files_(files) {}

  /// The table under a key.
  /// \throws TextError with the place in the scene, or in the file of points
  Table read(const YamlMap& map, const std::string& key, const TableUnits& units);

 private:
  Table readPoints(const Node& points,
                   const std::string& what,
                   const TableUnits& units,
                   Place place) const;
  Table readNamed(const YamlMap& spec, const TableUnits& units);
  Table readFile(const YamlMap& spec, const TableUnits& units);

  SceneBuilder& builder_;
  PointFiles& files_;
  std::map<std::string, Table> known_;  ///< tables by their files
  std::size_t points_ = 0;              ///< points of all tables so far
};

}  // namespace ergotic::scene
