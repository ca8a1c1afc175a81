// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Warns of what surprises who plays a scene: of every pluck that already holds what it plucks when
/// the scene starts, so that it sounds in the first millisecond, before anybody plays; and of a
/// scene that nothing can set into motion.
/// \param warnings  gets `file:line:col: warning: ...`, with what to do about it
void warnAboutPlaying(const scene::Scene& scene, std::vector<std::string>& warnings);

}  // namespace ergotic::physics
