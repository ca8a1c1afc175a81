// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// `{file: room.csv}` as the list that is in it: a line `azimuth,elevation,channel` for each
/// speaker, degrees, beside the scene. \param spec  a map
/// \throws TextError in the scene or in the file
Node speakersIn(const SceneBuilder& builder, const Node& spec, Place place);

}  // namespace ergotic::scene
