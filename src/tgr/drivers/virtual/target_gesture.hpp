// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "tgr/drivers/virtual/virtual_slice.hpp"

namespace ergotic::tgr {

/// Targets of the virtual hands over time, from a gesture file of either kind
/// (scene/text/gesture_csv.hpp). The first row of a file that counts ticks is time 0. Rows that set
/// parameters are skipped, see readGestureValues.
///
/// Between the rows of a slice the target moves on a straight line; before its first row it is the
/// first row's, after its last row the last one's; a slice without rows rests at 0.
class TargetGesture {
 public:
  /// Makes a gesture in which all slices rest at 0.
  explicit TargetGesture(int slices) : knots_(static_cast<std::size_t>(slices)) {}

  /// \param name  of the file, for messages
  /// \throws TextError with file:line:col, also of more slices, and beyond where a hand wants to be
  TargetGesture(std::istream& in, const std::string& name, int slices);

  /// Sets the ticks per second; no effect on a gesture of targets. \pre > 0
  void setTickRate(double tick_rate_hz) noexcept;

  /// Range of the rows of one slice.
  struct Range {
    bool is_empty = true;  ///< the slice has no rows
    double last_s = 0.0;   ///< time of the last row
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

/// Reads a gesture file; with an empty path the hands rest at 0.
/// \throws TextError; Exception if the file cannot be read
TargetGesture readTargetGesture(const std::string& path, int slices);

}  // namespace ergotic::tgr
