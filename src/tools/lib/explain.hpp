// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::tools {

/// Where something of a scene comes from: its place and the instances it is in, and what the plain
/// text says of it, or of the generator that made it.
/// \throws Exception if there is nothing of that name
std::string explain(const scene::Scene& scene, const std::string& name);

}  // namespace ergotic::tools
