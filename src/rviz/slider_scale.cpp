// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/slider_scale.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ergotic::panel {
namespace {

constexpr double kLinearDecades = 100.0;  // ratio of the ends up to which a range is linear

}  // namespace

SliderScale::SliderScale(double low, double high)
    : low_(low), high_(high), logarithmic_(low > 0.0 && high / low > kLinearDecades) {}

int SliderScale::stepAt(double value) const {
  if (!(value > low_)) {
    return 0;
  }
  if (value >= high_) {
    return kSteps;
  }
  const double share = logarithmic_ ? std::log(value / low_) / std::log(high_ / low_)
                                    : (value - low_) / (high_ - low_);
  return static_cast<int>(std::lround(share * kSteps));
}

double SliderScale::valueAt(int step) const {
  if (step <= 0) {
    return low_;
  }
  if (step >= kSteps) {
    return high_;
  }
  const double share = static_cast<double>(step) / kSteps;
  const double value =
      logarithmic_ ? low_ * std::pow(high_ / low_, share) : low_ + share * (high_ - low_);
  return std::clamp(value, low_, high_);
}

std::optional<double> Throttle::take(double now_s) {
  if (!waiting_ || (last_s_ && now_s < *last_s_ + period_s_)) {
    return std::nullopt;
  }
  last_s_ = now_s;
  return std::exchange(waiting_, std::nullopt);
}

}  // namespace ergotic::panel
