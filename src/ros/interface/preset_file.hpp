// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::node {

/// Values of parameters by their names.
using PresetValues = std::map<std::string, double>;

/// Folder of the presets: `$ROS_HOME/ergotic/presets`.
std::string presetFolder();

/// Name of the preset file of a scene: the name of the scene's file without ending, or its own name
/// if it came as a text.
std::string presetsOf(const scene::Scene& scene);

/// The presets of a scene: a YAML file `FOLDER/SCENE.yaml`, a map of names to maps of values.
/// Thread: one at a time
class PresetFile {
 public:
  static constexpr std::size_t kMaxPresets = 100;

  PresetFile(std::string folder, const std::string& scene)
      : folder_(std::move(folder)), path_(folder_ + "/" + scene + ".yaml") {}

  const std::string& path() const { return path_; }
  /// Reads all presets; none if there is no such file.
  /// \throws TextError with file:line:col; Exception if it cannot be read
  std::map<std::string, PresetValues> read() const;
  /// \throws Exception as `read`, or if there is none of this name
  PresetValues at(const std::string& name) const;
  /// Stores a preset, in place of one of the same name. \throws Exception as `read`, or if it
  /// cannot be written
  void keep(const std::string& name, const PresetValues& values) const;
  /// \throws Exception as `at`, or if it cannot be written
  void forget(const std::string& name) const;

 private:
  void write(const std::map<std::string, PresetValues>& presets) const;

  std::string folder_;
  std::string path_;
};

/// Part of a preset that fits a scene.
struct FittingValues {
  PresetValues values;
  std::string left_out;  ///< values left out, in words; empty: none
};
FittingValues fittingValues(const PresetValues& preset,
                            const std::vector<scene::Parameter>& parameters);

}  // namespace ergotic::node
