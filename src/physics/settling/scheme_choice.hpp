// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Makes every link with Scheme::kAuto explicit or guarded. Links onto a slower mass stay explicit,
/// because the guard is not proven there; so do links whose ends no force moves. Those with
/// Scheme::kExplicitIfStable stay explicit while the network is stable with all of them at their
/// steepest; the stiffest of them are guarded until it is.
void chooseSchemes(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

}  // namespace ergotic::physics
