// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/rates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "ergotic/exception.hpp"

namespace ergotic::physics {
namespace {

constexpr double kLowestAudioHz = 8000.0;
constexpr double kHighestAudioHz = 192000.0;

bool isLegalDivisor(int divisor, int ratio) {
  return divisor >= 1 && (ratio % divisor == 0 || divisor % ratio == 0);
}

int nearestLegalDivisor(int divisor, int ratio) {
  for (int away = 1;; ++away) {
    if (isLegalDivisor(divisor - away, ratio)) {
      return divisor - away;
    }
    if (isLegalDivisor(divisor + away, ratio)) {
      return divisor + away;
    }
  }
}

}  // namespace

int divisorOf(const scene::Section& section, const Rates& rates) {
  return section.gestural ? rates.ratio : section.divisor;
}

Rates chooseRates(const scene::Scene& scene, double audio_hz, double gestural_hz) {
  if (!(audio_hz >= kLowestAudioHz && audio_hz <= kHighestAudioHz)) {
    throw Exception("audio rate " + std::to_string(audio_hz) + " Hz: allowed 8000...192000 Hz");
  }
  const double wanted = gestural_hz > 0.0 ? gestural_hz : scene.gestural_rate_hz;
  if (!(wanted > 0.0)) {
    throw Exception("gestural rate " + std::to_string(wanted) + " Hz: must be positive");
  }
  const double ratio = std::round(audio_hz / wanted);
  if (gestural_hz > 0.0 && !(ratio >= 1.0 && ratio <= kMaxRatio)) {
    throw Exception("gestural rate " + std::to_string(gestural_hz) + " Hz: allowed " +
                    std::to_string(audio_hz / kMaxRatio) + "..." + std::to_string(audio_hz) +
                    " Hz at this audio rate");
  }
  const Rates rates{audio_hz, static_cast<int>(std::clamp(ratio, 1.0, double{kMaxRatio}))};
  for (const scene::Section& section : scene.sections) {
    if (!section.gestural && !isLegalDivisor(section.divisor, rates.ratio)) {
      throw Exception(scene.file + ":" + std::to_string(section.place.line) + ":" +
                      std::to_string(section.place.column) + ": error: section '" + section.name +
                      "' is stepped every " + std::to_string(section.divisor) +
                      " audio frames, which neither divides nor is a multiple of the " +
                      std::to_string(rates.ratio) +
                      " frames of a tick; the nearest legal value is " +
                      std::to_string(nearestLegalDivisor(section.divisor, rates.ratio)));
    }
  }
  return rates;
}

}  // namespace ergotic::physics
