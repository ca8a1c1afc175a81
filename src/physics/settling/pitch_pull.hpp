// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Rise in pitch of a string in a plane or in space at large amplitude, cents above its pitch at
/// rest; a scalar string keeps its pitch.
/// \param slack      rest length of a link over its length in the string, 0...1
/// \param amplitude  of the fundamental over the length of the string
double pitchPullCents(double slack, double amplitude);

/// Why a string does not hold its pitch, and what would help. \pre it does not
std::string flatness(const scene::Scene& scene, const scene::StringInfo& string, double rate_hz);

/// Says of every string in a plane or in space what it gains by not being scalar, or that it does
/// not hold its pitch. \pre schemes and rates are chosen
void notePitchPull(const scene::Scene& scene, std::vector<std::string>& notes);

}  // namespace ergotic::physics
