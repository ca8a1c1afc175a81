// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace ergotic::panel {

constexpr double kVolumeDecibels = 60.0;  ///< below full scale, where meters and the slider end
constexpr int kVolumeSteps = 120;         ///< half a decibel each

/// Position of a level on a meter, 0...1. \param level  relative to full scale
inline double shareOfDecibels(double level) {
  const double floor = std::pow(10.0, -kVolumeDecibels / 20.0);
  return level > floor ? std::min(1.0 + std::log10(level) * 20.0 / kVolumeDecibels, 1.0) : 0.0;
}

/// Gain of a step of the volume slider: silence at 0, 1 at the end.
inline double volumeAt(int step) {
  return step <= 0 ? 0.0
                   : std::pow(10.0, kVolumeDecibels / 20.0 *
                                        (static_cast<double>(step) / kVolumeSteps - 1.0));
}

/// The nearest step.
inline int stepOfVolume(double volume) {
  return static_cast<int>(std::lround(shareOfDecibels(volume) * kVolumeSteps));
}

}  // namespace ergotic::panel
