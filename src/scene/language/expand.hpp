// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// True if a scene says anything that only `expand` understands: `let`, `define`, `use`, `include`,
/// `defaults`, `variants`, `for`, `when`, `class`, expressions (`=...`), names with `{...}`, files
/// of speakers.
bool usesLanguage(const Node& scene);

/// The plain scene: constants put in, definitions written out, elements with `for` repeated. It is
/// total: definitions use those above them alone, loops go over what is written down, and all of it
/// is counted.
/// \param builder  for messages; is told where instances come from, and what variants there are
/// \param variant  "": none
/// \throws TextError with the place and the instances it is in
Node expand(SceneBuilder& builder, const Node& scene, const std::string& variant);

}  // namespace ergotic::scene
