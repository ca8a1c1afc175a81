// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Cubic links with Scheme::kAuto that harden one body share one tank of energy: guarded one by
/// one, each of them lags by itself, and beside a contact the pitch rises too far and the hand
/// gives too much. What of them is linear becomes a spring and damper beside, `<name>.linear`,
/// which stays explicit. Not where the rules of a tank forbid it, nor a single link.
void shareTanks(scene::Scene& scene, std::vector<std::string>& notes);

}  // namespace ergotic::physics
