// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "tgr/drivers/virtual/virtual_slice.hpp"

namespace ergotic::tgr {

/// Where the virtual hands want to be over time, from a gesture file of either kind
/// (scene/text/gesture_csv.hpp). The first row of one that counts ticks is time 0. Rows that set
/// parameters are passed over, see readGestureValues.
///
/// Between the rows of a slice the target moves on a straight line; before its first row it is the
/// first row's, after its last row the last one's; a slice without rows rests at 0.
class TargetGesture {
 public:
  /// All slices rest at 0.
  explicit TargetGesture(int slices) : knots_(static_cast<std::size_t>(slices)) {}

  /// \param name  of the file, for messages
  /// \throws TextError with file:line:col, also of more slices, and beyond where a hand wants to be
  TargetGesture(std::istream& in, const std::string& name, int slices);

  /// Ticks per second; of targets without effect. \pre > 0
  void setTickRate(double tick_rate_hz) noexcept;

  /// What the rows of one slice ask for.
  struct Range {
    bool is_empty = true;  ///< there are none
    double last_s = 0.0;   ///< time of the last one
    double lowest_m = 0.0;
    double highest_m = 0.0;
  };
  Range rangeOf(int slice) const;

  /// \param t_s  from the start of the gesture. Realtime: yes (binary search)
  HandTarget at(int slice, double t_s) const noexcept;

 private:
  struct Knot {
    double t;  // s, or ticks
    double target_m;
  };
  std::vector<std::vector<Knot>> knots_;  // [slices]
  bool is_in_ticks_ = false;
  double per_second_ = 1.0;  // what `t` counts
};

/// An empty path stands for hands that rest at 0.
/// \throws TextError; Exception if the file cannot be read
TargetGesture readTargetGesture(const std::string& path, int slices);

}  // namespace ergotic::tgr
