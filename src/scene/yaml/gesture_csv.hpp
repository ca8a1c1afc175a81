// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/yaml/point_files.hpp"

namespace ergotic::scene {

/// Where one slice of a gesture file goes.
struct GestureOfSlice {
  bool in_ticks = false;  ///< the first number of a point is a tick, from 0; otherwise s
  PointList points;       ///< and m; at least one, the first numbers increasing
};

/// Reads one slice of a text of lines `time_s,slice,target_m`, or `tick,x0,x1,...` below a header
/// that says so.
/// \param file  for messages
/// \throws TextError with line and column in that file; also if it has nothing of the slice
GestureOfSlice readGestureCsv(const std::string& text, const std::string& file, int slice);

}  // namespace ergotic::scene
