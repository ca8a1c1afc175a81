// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::station {

/// Keeps sound below full scale, for people wear headphones: a peak limiter with one gain for all
/// channels, which falls at once and comes back over `kReleaseS`. While the gain is whole, sound
/// below the ceiling passes bit for bit. Thread: one
class Limiter {
 public:
  static constexpr double kCeiling = 0.98;  ///< relative to full scale, -0.2 dBFS
  static constexpr double kReleaseS = 0.2;  ///< time constant

  /// \param rate_hz  of frames
  explicit Limiter(double rate_hz) : release_(-std::expm1(-1.0 / (kReleaseS * rate_hz))) {}

  /// Gain for the next frame. \param peak  largest magnitude of its samples, finite
  /// Realtime: yes
  float gainFor(float peak) noexcept {
    constexpr double kWhole = 0.99999;  // above it the gain is 1 again
    gain_ = gain_ >= kWhole ? 1.0 : gain_ + release_ * (1.0 - gain_);
    if (const double loud = static_cast<double>(peak); gain_ * loud > kCeiling) {
      gain_ = kCeiling / loud;
    }
    return static_cast<float>(gain_);
  }

 private:
  double release_;
  double gain_ = 1.0;  // in single precision it would not come back whole
};

}  // namespace ergotic::station
