// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

namespace ergotic::panel {

/// Map from the range of a parameter to the steps of a slider and back. Ranges of more than two
/// decades above zero are logarithmic: each step is the same ratio then.
class SliderScale {
 public:
  static constexpr int kSteps = 1000;

  /// \pre both finite, low <= high
  SliderScale(double low, double high);

  bool isLogarithmic() const { return logarithmic_; }
  /// The nearest step, 0...kSteps; values out of range, or not a number, are put to an end.
  int stepAt(double value) const;
  /// Exactly `low` and `high` at the ends, and within them everywhere.
  double valueAt(int step) const;

 private:
  double low_;
  double high_;
  bool logarithmic_;
};

/// Lets values through so often at most; of those that come meanwhile, the newest waits.
class Throttle {
 public:
  /// \param period_s  the least time between two, s
  explicit Throttle(double period_s) : period_s_(period_s) {}

  void offer(double value) { waiting_ = value; }
  /// The value to be sent now, once. \param now_s  of a clock that never goes back, s
  std::optional<double> take(double now_s);

 private:
  double period_s_;
  std::optional<double> waiting_;
  std::optional<double> last_s_;
};

}  // namespace ergotic::panel
