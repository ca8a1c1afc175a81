// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {

using PointList = std::vector<std::pair<double, double>>;
using RowList = std::vector<std::vector<double>>;

/// Files of points beside a scene.
///
/// A text must mean the same wherever it is read. So the points of files are appended to
/// Scene::text as a second document, `tables: {"name.csv": [[x, y], ...], ...}`,
/// `gestures: {agent: [[t, x], ...], ...}` and `partials: {"name.csv": [[f, t60, mass, ...],
/// ...]}`; where a text has one, all points come from there and no file is opened.
class PointFiles {
 public:
  enum class Part { kTables, kGestures, kPartials };

  /// \param document  the second one, nullptr if there is none
  /// \throws TextError if it has another form
  PointFiles(SceneBuilder& builder, const Node* document);

  /// True if no file is opened.
  bool isSelfContained() const { return self_contained_; }

  struct Appended {
    const Node* points = nullptr;
    Place place;
    bool used = false;
  };
  /// Points of the second document, nullptr if it does not have them.
  const Appended* find(Part part, const std::string& key);

  struct File {
    std::string text;
    std::string path;
  };
  /// The name of the file under the key `file`.
  /// \throws TextError at that key if it is no path from the scene's folder
  static std::string nameOf(const YamlMap& spec);
  /// The file under the key `file`. \throws TextError as `nameOf`, or if it cannot be read
  File open(const YamlMap& spec) const;

  /// Keeps points that `finish` has to append.
  void keep(Part part, const std::string& key, const PointList& points);
  void keep(Part part, const std::string& key, const RowList& rows);

  /// Appends what was kept to Scene::text.
  /// \throws TextError if the second document has points that nothing uses, or if the text gets
  ///         longer than a text may be
  void finish();

 private:
  void append();

  SceneBuilder& builder_;
  bool self_contained_ = false;
  std::map<std::pair<Part, std::string>, Appended> appended_;
  std::map<std::pair<Part, std::string>, std::string> kept_;  ///< as they are written
};

}  // namespace ergotic::scene
