// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// The documents of a text; none if there is nothing in it.
/// \param most   1 or 2
/// \param needs  how deep a text may nest, for messages
/// \throws TextError where the text is not YAML, or at a document that is one too many
std::vector<YAML::Node> readDocuments(const SceneBuilder& builder,
                                      const std::string& text,
                                      int most,
                                      const std::string& needs);

}  // namespace ergotic::scene
