// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Says where single precision heats a scene: its springs see distances rounded by 6e-8, which is a
/// force of noise, and what loses little keeps what that gives. An upper estimate of the speed that
/// all modules of such a part come to in a minute, by the law of large numbers; those below 5 cm/s
/// are left out, as is what a body adds by flying away from where it was built.
///
/// Realtime: no. Source: docs/physics/stability.md, "How a scene is certified".
std::vector<std::string> notesOnRounding(const scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
