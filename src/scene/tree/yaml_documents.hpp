// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// The documents of a text; none if there is nothing in it.
/// \param most   1 or 2
/// \param needs  how deep a text may nest, for messages
/// \throws TextError where the text is not YAML, at an alias, or at a document or a value that is
///         one too many
std::vector<Node> readDocuments(const SceneBuilder& builder,
                                const std::string& text,
                                int most,
                                const std::string& needs);

}  // namespace ergotic::scene
