// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/slopes.hpp"

namespace ergotic::physics {

/// m: where the slopes of a law grow without an end, hands move so far from the start.
constexpr double kHandDepth = 1e-3;

/// The steepest slopes of a link that a hand meets, see kHandDepth; of others, up to as far.
scene::Slopes slopesInHand(const scene::Scene& scene, const scene::Lia& lia);

}  // namespace ergotic::physics
