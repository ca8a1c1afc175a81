// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Gives every body that asks for a pitch the springs, bends, dampers and losses with which it
/// sounds there and decays as asked at the rate of its section, exactly: a mode of the eigenvalue
/// lambda and the damping D of its links has kappa = h^2 lambda and, with the loss Y to the ground,
/// zeta = 1 - e^(-Y h/M) + h D, and rings with e^(-sigma t) where zeta = 1 - e^(-2 sigma h). Says
/// which partials it has then. None is left open; what has no modes is no body, but stops.
/// \throws TextError if a body cannot sound or decay so, with what would help
void tuneBodies(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

}  // namespace ergotic::physics
