// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "ergotic/advice/modes.hpp"

namespace ergotic::physics {

/// Pitches that bodies in tune, strings and resonators of a scene that is not settled ask for.
std::vector<AskedPitch> askedPitchesOf(const scene::Scene& asked);

struct PlacedMode {
  double frequency_hz = 0.0;
  const std::vector<std::pair<int, double>>* shares = nullptr;  ///< kinetic energy by module
};

struct PitchMatch {
  int asked = -1;
  double cents = 0.0;
};

/// [modes] The pitch that each mode is: each pitch takes the nearest mode within a semitone of
/// those with a third of their energy in its body. Marks what is found. \param scene  settled
std::vector<PitchMatch> matchPitches(const scene::Scene& scene,
                                     const scene::Scene& asked,
                                     std::vector<AskedPitch>& pitches,
                                     const std::vector<PlacedMode>& modes);

/// [modes][askedPitchesOf] how much of its kinetic energy a mode has in the body, 0...1.
std::vector<std::vector<double>> sharesInBodies(const scene::Scene& asked,
                                                const std::vector<PlacedMode>& modes);

}  // namespace ergotic::physics
