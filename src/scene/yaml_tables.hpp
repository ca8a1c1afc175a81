// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>

#include "scene/scene_builder.hpp"
#include "scene/yaml_map.hpp"

namespace ergotic::scene {

/// The tables of a scene, wherever their points are: `[[x, y], ...]`, or
/// `{points: [[x, y], ...], interpolation: ...}`, or `{file: name.csv, interpolation: ...}`.
///
/// A text must mean the same wherever it is read. So the points of files are appended to
/// Scene::text as a second document, `tables: {"name.csv": [[x, y], ...], ...}`; where a text has
/// one, the points come from there and no file is opened.
class YamlTables {
 public:
  /// \param appended  the second document, nullptr if there is none
  /// \throws TextError if it has another form
  YamlTables(SceneBuilder& builder, const YAML::Node* appended);

  /// The table under a key.
  /// \throws TextError with the place in the scene, or in the file of points
  Table read(const YamlMap& map, const std::string& key);

  /// Appends what was read from files to Scene::text.
  /// \throws TextError if the second document has tables that no link uses, or if the text gets
  ///         longer than a text may be
  void finish();

 private:
  struct Appended {
    YAML::Node points;
    Place place;
  };
  Table readPoints(const YAML::Node& points, const std::string& what, Place place) const;
  Table readNamed(const YamlMap& spec);
  Table readFile(const YamlMap& spec, const std::string& name);

  SceneBuilder& builder_;
  bool self_contained_ = false;
  std::map<std::string, Appended> appended_;
  std::set<std::string> used_;  ///< of these
  std::map<std::string, Table> files_;
  std::size_t points_ = 0;  ///< of all tables so far
};

}  // namespace ergotic::scene
