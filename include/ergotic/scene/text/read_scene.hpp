// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// Values given from outside in place of those in the text (`--set NAME=V`).
using Overrides = std::map<std::string, double>;

/// Choice of what is read of a text.
struct Choice {
  std::string variant;     ///< one of `variants`; "": none
  bool has_folder = true;  ///< in which it is, and in which files are that it names; else it may
                           ///< name none
};

/// Reads a scene file; `.mdl` selects the MIMS reader, anything else is YAML.
///
/// All readers give a whole valid scene or throw. `Scene::text` is the text as it was given,
/// without the overrides, and with the points of table files appended to it: wherever it is read
/// again, `readScene(scene.text, scene.file, overrides)` with the same overrides gives the same
/// scene and opens no file.
///
/// Overrides replace the value of a parameter (YAML: within its range; `.mdl`: a `param`), or
/// `gestural_rate`, Hz, before anything is computed from it.
/// Realtime: no. Thread: any.
/// \param choice  it is in Scene::text, too: what is read again needs none
/// \throws TextError with file:line:col; Exception if the file cannot be read, or if an override is
///         unknown or out of range
Scene readSceneFile(const std::string& path,
                    const Overrides& overrides = {},
                    const Choice& choice = {});

/// Reads text by the ending of its name, as readSceneFile does.
Scene readScene(const std::string& text,
                const std::string& name,
                const Overrides& overrides = {},
                const Choice& choice = {});

/// Reads YAML text (docs/scene.md); `name` stands for the file in messages.
Scene readYaml(const std::string& text,
               const std::string& name,
               const Overrides& overrides = {},
               const Choice& choice = {});

/// Reads MIMS `.mdl` text, dialect D2 (the one with `[x y z]` vectors), without macros.
Scene readMdl(const std::string& text, const std::string& name, const Overrides& overrides = {});

}  // namespace ergotic::scene
