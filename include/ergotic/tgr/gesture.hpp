// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/scene/value.hpp"

namespace ergotic::tgr {

/// Recorded positions of the slices, tick by tick.
class GestureSource {
 public:
  virtual ~GestureSource() = default;
  /// Slices per tick, 1...kMaxSlices, constant.
  virtual int slices() const noexcept = 0;
  /// Gives the next tick. Realtime: as its maker says; `readPositionsCsv`: yes.
  /// \param[out] positions  [slices] m; untouched if there are none
  /// \return false if this tick is missing; at the end, then and ever after
  virtual bool next(double* positions) noexcept = 0;
};

/// Reads a CSV of positions per tick into memory: a line `tick,x0,x1,...` and one line of numbers
/// per tick, positions in metres, ticks counting up by one; `#` starts a comment line.
/// \throws TextError with file:line:col; Exception if the file cannot be read
std::unique_ptr<GestureSource> readPositionsCsv(const std::string& path);

constexpr std::size_t kTicksAhead = 8192;
/// Ticks of a source that takes its time, such as a file, read ahead by a thread of their own, the
/// first of them here. A tick that is not there when it is asked for is left out, as at the end:
/// those that are given are always those of their time. Realtime: yes
/// \throws Exception if it has not 1...kMaxSlices slices
std::unique_ptr<GestureSource> readAhead(std::unique_ptr<GestureSource> slow,
                                         std::size_t ticks = kTicksAhead);

/// The two kinds of gesture files.
enum class GestureKind {
  kTargets,   ///< `time_s,slice,target_m`: where a virtual hand wants to be
  kPositions  ///< `tick,x0,...`: where the slices were, for `readPositionsCsv`
};

/// Tells the kinds apart by the first line that is not a comment; what does not start with `tick`
/// is taken for targets.
/// \throws Exception if the file cannot be read
GestureKind gestureKindOf(const std::string& path);

/// A row `time_s,$name,value` of a gesture file. Whoever plays the scene sets its parameter: the
/// device, which knows no scene, has no part in it.
struct GestureValue {
  double time_s = 0.0;  ///< time since the gesture began
  std::string parameter;
  double value = 0.0;
  std::string file;  ///< name of the file, for messages
  scene::Place name_at;
  scene::Place value_at;
};

/// Reads the parameter values of a gesture file, in order of time; none from a file of positions,
/// and none if no file is named.
/// \throws TextError; Exception if the file cannot be read
std::vector<GestureValue> readGestureValues(const std::string& path);

/// \return index of the parameter that it sets
/// \throws TextError if there is none of this name, or the value is outside its range
std::size_t parameterOf(const GestureValue& value, const std::vector<scene::Parameter>& parameters);

}  // namespace ergotic::tgr
