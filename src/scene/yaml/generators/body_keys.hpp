// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scene/generate/modal_body.hpp"
#include "scene/yaml/yaml_elements.hpp"

/// Keys that all bodies with a pitch have.
namespace ergotic::scene {

constexpr Limits kT60Limits{"s", 1e-4, 1e4};
constexpr int kMassesOfModes = 150;  ///< masses of a body that is stepped as its modes

/// `keys`, and those of every body.
std::vector<std::string> withBodyKeys(std::vector<std::string> keys);

/// `pitch`, `pitch_of`, `t60`. \throws TextError
BodyWish readBodyWish(const SceneBuilder& builder, const YamlMap& map);

/// `as`, `partials`, `places`. \param is_flat  its places are [along, across]
BodyForm readBodyForm(const SceneBuilder& builder, const YamlMap& map, bool is_flat);

/// A number of masses that modes do not need. \throws TextError if a network has none
int readCount(const YamlMap& map,
              const std::string& key,
              const Limits& limits,
              const BodyForm& form,
              int of_modes);

/// A scalar section, in which what a body loses is what it asks for. \throws TextError
int bodySection(const SceneBuilder& builder, const YamlMap& map);

}  // namespace ergotic::scene
