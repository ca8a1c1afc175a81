// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Makes frets and barriers as stiff as what they stop bears at its rate: K = c M/h^2, M the mass
/// that a contact meets, c = 3, or 0.8 of what the springs of the string leave of 4 if that is
/// less. Frets between two masses are moved until the string sounds as if it ended there, whatever
/// they yield. Leaves none open.
/// \pre strings and bodies are tuned: what is left of Scene::tunings are stops
void settleStops(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes);

}  // namespace ergotic::physics
