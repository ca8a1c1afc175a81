// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// Limits the force, to the setting and to the compiled-in maximum. Realtime: yes
class ForceLimit {
 public:
  explicit ForceLimit(double limit_n) noexcept
      : limit_n_(std::clamp(limit_n, 0.0, kAbsoluteForceLimitN)) {}

  /// Limited force, N; not a number becomes 0.
  double limited(double force) const noexcept {
    return std::isnan(force) ? 0.0 : std::clamp(force, -limit_n_, limit_n_);
  }

 private:
  double limit_n_;
};

}  // namespace ergotic::tgr
