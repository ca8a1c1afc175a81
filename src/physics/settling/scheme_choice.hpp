// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Where an explicit link may make energy (h the step of the link, slopes and masses at the worst
/// ends of their ranges): the rules of `scheme: auto`.
constexpr double kExplicitSwitch = 0.05;   ///< h^2 K (1/Ma + 1/Mb) of contacts and clipped springs
constexpr double kExplicitFriction = 1.0;  ///< h max F' (1/Ma + 1/Mb), from here on guarded
constexpr double kExplicitFalling = 0.2;   ///< h max(-F') (1/Ma + 1/Mb), from here on guarded

/// Makes every link with Scheme::kAuto explicit or guarded. Links onto a slower mass stay explicit,
/// because the guard is not proven there; so do links whose ends no force moves.
void chooseSchemes(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

}  // namespace ergotic::physics
