// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/generate/scene_builder.hpp"

/// Files that a scene names. Errors in one tell what it says, and a scene may be a stranger's: so
/// they are in the scene's folder or below it.
namespace ergotic::scene {

/// Path of a file, links not followed.
/// \param name  relative to the scene's folder
/// \param of    what names it, for messages; "" where the place says enough
/// \throws TextError if it is elsewhere, or if the scene is a text without a folder
std::string pathOfNear(const SceneBuilder& builder,
                       const std::string& name,
                       const std::string& of,
                       Place place);

/// Path of a file of definitions: near the scene or, if there is none, among those that are
/// shipped, which a text without a folder may name, too. \throws TextError as `pathOfNear`
std::string pathOfIncluded(const SceneBuilder& builder, const std::string& name, Place place);

/// Text of such a file, up to `most` bytes. \throws TextError if it cannot be read
std::string readNear(const SceneBuilder& builder,
                     const std::string& path,
                     std::size_t most,
                     const std::string& of,
                     Place place);

}  // namespace ergotic::scene
