// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "scene/tree/yaml_map.hpp"

namespace ergotic::tgr {

/// \return what the text says; nothing at all is an empty map
/// \param file  for messages
/// \throws TextError if it is not YAML
YAML::Node parseSettings(const std::string& text, const std::string& file);

/// A YAML map of settings, read with what reads scenes: every getter of `top()` throws TextError
/// with file:line:col, value and allowed range.
class Settings {
 public:
  /// \param node  a map
  /// \param file  for messages
  /// \param what  for messages, as in `driver virtual`
  /// \throws TextError if it is not a map
  Settings(const YAML::Node& node, const std::string& file, const std::string& what);
  Settings(const Settings&) = delete;
  Settings& operator=(const Settings&) = delete;

  const scene::YamlMap& top() const noexcept { return top_; }
  const YAML::Node& node() const noexcept { return node_; }
  /// Builder for `scene::YamlMap`s of nested maps.
  const scene::SceneBuilder& builder() const noexcept { return builder_; }

 private:
  scene::SceneBuilder builder_;
  YAML::Node node_;
  scene::Node tree_;  // of it
  scene::YamlMap top_;
};

/// Writes YAML on one line that reads back as the same.
std::string textInLine(const YAML::Node& node);

}  // namespace ergotic::tgr
