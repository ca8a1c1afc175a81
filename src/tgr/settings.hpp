// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/yaml/yaml_map.hpp"

namespace ergotic::tgr {

/// A YAML map of settings, read with what reads scenes: every getter of `top()` throws TextError
/// with file:line:col, value and allowed range.
class Settings {
 public:
  /// \param text  a map; nothing at all is an empty map
  /// \param file  for messages
  /// \param what  for messages, as in `driver virtual`
  /// \throws TextError if it is not a map, or not YAML
  Settings(const std::string& text, const std::string& file, const std::string& what);
  Settings(const Settings&) = delete;
  Settings& operator=(const Settings&) = delete;

  const scene::YamlMap& top() const noexcept { return top_; }
  const YAML::Node& node() const noexcept { return node_; }
  /// For `scene::YamlMap`s of maps that are deeper inside.
  const scene::SceneBuilder& builder() const noexcept { return builder_; }

 private:
  scene::SceneBuilder builder_;
  YAML::Node node_;
  scene::YamlMap top_;
};

/// A part of a YAML text as a text of its own (flow style), in which everything stands on the line
/// and, where there is room, in the column that it had: messages about it fit the whole text.
/// \throws TextError if it is longer than a settings' text can be, as aliases of aliases are
std::string textInPlace(const scene::SceneBuilder& builder, const YAML::Node& node);

/// The same on one line.
std::string textInLine(const scene::SceneBuilder& builder, const YAML::Node& node);

/// A path as it stands in a file: relative ones start where the file is.
std::string besideFile(const std::string& path, const std::string& file);

/// The shortest text that reads back as the very same number.
std::string shortest(double value);

}  // namespace ergotic::tgr
