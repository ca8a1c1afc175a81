// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

constexpr int kMaxRatio = 48;  ///< largest number of audio frames per tick

/// The rates a scene is run at.
struct Rates {
  double audio_hz = 44100.0;
  int ratio = 14;  ///< R, audio frames per tick, 1...kMaxRatio
  double gesturalHz() const { return audio_hz / ratio; }
};

/// The ratio nearest to what is wanted.
/// \param gestural_hz  wanted gestural rate; 0: the scene's own wish, met as far as 1...kMaxRatio
/// \throws Exception if `gestural_hz` is out of reach, the audio rate is outside 8...192 kHz or
/// a section's divisor neither
///         divides R nor is a multiple of it (the message names the nearest legal one)
Rates chooseRates(const scene::Scene& scene, double audio_hz, double gestural_hz = 0.0);

/// Audio frames per step of a section.
int divisorOf(const scene::Section& section, const Rates& rates);

}  // namespace ergotic::physics
