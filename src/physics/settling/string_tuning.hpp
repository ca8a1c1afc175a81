// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Gives every string that asks for a frequency the springs with which it sounds there at the rate
/// of its own section, with its damping: exactly, by itself, and at the present values of the
/// parameters; the upper partials of coarse strings as near as three springs can.
/// \throws TextError if a string cannot sound there, with what would help
void tuneStrings(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

}  // namespace ergotic::physics
