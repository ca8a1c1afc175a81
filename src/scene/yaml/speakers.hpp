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

/// Speakers around the listener, and the gains that pan a direction to them.
struct Speakers {
  std::vector<int> channels;  ///< output channel of each speaker, from 0
  Panner panner;
};

/// The layouts of a scene: `stereo`, `quad`, `ring8`, `dome24`, or `[[azimuth, elevation, channel],
/// ...]`.
class Layouts {
 public:
  explicit Layouts(const SceneBuilder& builder) : builder_(builder) {}

  /// The speakers that the value of a key asks for. \throws TextError
  const Speakers& read(const YamlMap& map, const std::string& key);

 private:
  const SceneBuilder& builder_;
  std::map<std::string, Speakers> known_;  ///< by the text that asks for them
};

}  // namespace ergotic::scene
