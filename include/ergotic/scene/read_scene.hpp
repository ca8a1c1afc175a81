// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// Values given from outside in place of those in the text (`--set NAME=V`).
using Overrides = std::map<std::string, double>;

/// Reads a scene file; `.mdl` selects the MIMS reader, anything else is YAML.
/// \throws TextError with file:line:col; Exception if the file cannot be read
Scene readSceneFile(const std::string& path, const Overrides& overrides = {});

/// Reads YAML text; `name` stands for the file in messages.
Scene readYaml(const std::string& text, const std::string& name, const Overrides& overrides = {});

/// Reads MIMS `.mdl` text, dialect D2 (the one with `[x y z]` vectors), without macros.
Scene readMdl(const std::string& text, const std::string& name, const Overrides& overrides = {});

}  // namespace ergotic::scene
