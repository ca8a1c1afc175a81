// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::scene {

/// The JSON schema (draft 7) of YAML scenes, for editors: which keys each part has and what stands
/// under them, from the tables that the readers use. Whether numbers are in range, names are known
/// and keys are missing only reading tells.
std::string schemaOfScenes();

}  // namespace ergotic::scene
