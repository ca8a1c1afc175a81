// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace ergotic::tgr {

/// Limits how fast |F| grows; it may fall at once. A force that changes its side starts from 0
/// there. Realtime: yes
class SlewLimit {
 public:
  /// \param step_n  largest growth per tick, N
  explicit SlewLimit(double step_n) noexcept : step_n_(step_n) {}

  /// \param wanted  N
  /// \param last    N, what went out at the last tick
  double limited(double wanted, double last) const noexcept {
    const bool same_side = wanted * last >= 0.0;
    const double most = (same_side ? std::abs(last) : 0.0) + step_n_;
    return std::clamp(wanted, -most, most);
  }

 private:
  double step_n_;
};

}  // namespace ergotic::tgr
