// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"

namespace ergotic::tools {

/// Explains the origin of an element of a scene: its place, its instances, and its plain text, or
/// that of the generator that made it.
/// \throws Exception if there is nothing of that name
std::string explain(const scene::Scene& scene, const std::string& name);

}  // namespace ergotic::tools
