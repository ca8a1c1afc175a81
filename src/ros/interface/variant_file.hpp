// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"
#include "ros/interface/preset_file.hpp"

namespace ergotic::node {

/// A scene with one more variant, in which parameters have other values.
/// \param text  YAML, `variants` in block style if there are any
/// \param file  for messages
/// \throws Exception if `variants` is in flow style
std::string withVariant(const std::string& text,
                        const std::string& file,
                        const std::string& name,
                        const PresetValues& values);

/// A written copy of a scene, and the notes about it.
struct SavedVariant {
  std::string path;
  bool is_written_out = false;  ///< it has the scene's plain text, not that of its file
};

/// Writes `FOLDER/SCENE/NAME.yaml`: the text of the scene's file, or where that cannot be read from
/// there, or is not what plays, the scene as recordings keep it; and a variant `name` with these
/// values of parameters. It is read again before it is written.
/// \param scene  that plays
/// \throws Exception if it is an `.mdl` file, `variants` is in flow style, what was written reads
/// as
///         something else, or it cannot be written
SavedVariant saveVariant(const std::string& folder,
                         const scene::Scene& scene,
                         const std::string& name,
                         const PresetValues& values);

}  // namespace ergotic::node
