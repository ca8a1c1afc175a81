// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace ergotic::panel {

/// Maxima of several values over the last second: numbers that change sixty times a second cannot
/// be read, and a pluck is over before it is seen.
class PeakHold {
 public:
  static constexpr double kHoldS = 1.0;

  /// \param values  [n], any n \param now_s  of a clock that never goes back, s
  /// \return [n] the largest sizes
  const std::vector<double>& follow(const std::vector<double>& values, double now_s) {
    peaks_.resize(values.size());
    since_s_.resize(values.size(), now_s);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double size = std::abs(values[i]);
      if (size >= peaks_[i] || now_s >= since_s_[i] + kHoldS) {
        peaks_[i] = size;
        since_s_[i] = now_s;
      }
    }
    return peaks_;
  }

 private:
  std::vector<double> peaks_;
  std::vector<double> since_s_;
};

}  // namespace ergotic::panel
