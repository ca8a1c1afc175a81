// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

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

}  // namespace ergotic::tgr
