// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// Changes that a variant makes to a scene: `{let: {constant: value}, set: {NAME.key: value}}`.
class Variant {
 public:
  explicit Variant(const SceneBuilder& builder) : builder_(builder) {}

  /// Reads `variants`, and takes the one that is wanted; "" is none.
  /// \throws TextError; Exception that lists those there are if there is none of that name
  void read(const Node& scene, const std::string& wanted);

  /// Value of a constant; `otherwise` if the variant does not change it.
  const Node& constant(const std::string& name, const Node& otherwise);

  /// Keys of the element or instance of that name, with their values.
  using Setting = std::pair<std::string, const Node*>;
  std::vector<Setting> settingsOf(const std::string& name);

  /// The value of a parameter, nullptr: as it is.
  const Node* parameter(const std::string& name);

  /// \throws TextError at what nothing of the scene has asked for
  void expectUsed() const;

  /// Names of all variants of the scene.
  const std::vector<std::string>& known() const noexcept { return known_; }

 private:
  const SceneBuilder& builder_;
  std::vector<std::string> known_;
  const Node* let_ = nullptr;
  const Node* set_ = nullptr;
  std::set<const Node*> used_;
};

}  // namespace ergotic::scene
