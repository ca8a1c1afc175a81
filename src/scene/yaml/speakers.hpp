// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/generate/vbap.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {

/// Speakers around the listener, and what is heard of a direction from each.
struct Speakers {
  std::vector<int> channels;  ///< from 0, of each speaker
  Panner panner;
};

/// The layouts of a scene: `stereo`, `quad`, `ring8`, `dome24`, or `[[azimuth, elevation, channel],
/// ...]`.
class Layouts {
 public:
  explicit Layouts(const SceneBuilder& builder) : builder_(builder) {}

  /// What is under a key. \throws TextError
  const Speakers& read(const YamlMap& map, const std::string& key);

 private:
  const SceneBuilder& builder_;
  std::map<std::string, Speakers> known_;  ///< by what was said
};

}  // namespace ergotic::scene
