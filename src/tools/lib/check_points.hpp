// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// The points of a scene: on which grid and where, or of which modules with which weights.
Json pointsOf(const scene::Scene& scene);

}  // namespace ergotic::tools
