// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/bag/positions.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "bag/recorded_message.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::bag {
namespace {

/// Recorded positions; those of a stretch are read when it begins.
class RecordedPositions : public tgr::GestureSource {
 public:
  explicit RecordedPositions(Recording recording)
      : recording_(std::move(recording)), tick_(recording_.stretches.front().first_tick) {}

  int slices() const noexcept override {
    return static_cast<int>(recording_.stretches.front().slices);
  }

  bool next(double* positions) noexcept override {
    const std::vector<Stretch>& stretches = recording_.stretches;
    while (stretch_ < stretches.size() && tick_ >= stretches[stretch_].endTick()) {
      ++stretch_;
    }
    if (stretch_ == stretches.size()) {
      return false;
    }
    // Between two stretches the last tick of the one before is held.
    const std::size_t played = tick_ < stretches[stretch_].first_tick ? stretch_ - 1 : stretch_;
    if (!bring(played)) {
      return false;
    }
    const Stretch& stretch = stretches[played];
    const std::int64_t row = std::min(tick_, stretch.endTick() - 1) - stretch.first_tick;
    std::copy_n(stretch.positions.begin() + row * static_cast<std::ptrdiff_t>(stretch.slices),
                stretch.slices, positions);
    ++tick_;
    return true;
  }

 private:
  /// \return false if the file cannot be read any more
  bool bring(std::size_t stretch) noexcept {
    if (!recording_.load || (is_here_ && *is_here_ == stretch)) {
      return true;
    }
    try {
      if (is_here_) {
        recording_.unload(recording_.stretches[*is_here_]);
      }
      recording_.load(recording_.stretches[stretch]);
      is_here_ = stretch;
      return true;
    } catch (const std::exception&) {
      stretch_ = recording_.stretches.size();  // the end
      return false;
    }
  }

  Recording recording_;  // no stretch is empty
  std::size_t stretch_ = 0;
  std::optional<std::size_t> is_here_;
  std::int64_t tick_;
};

}  // namespace

std::unique_ptr<tgr::GestureSource> positionsOf(Recording recording, const std::string& path) {
  std::vector<Stretch>& stretches = recording.stretches;
  stretches.erase(std::remove_if(stretches.begin(), stretches.end(),
                                 [](const Stretch& stretch) { return stretch.flags.empty(); }),
                  stretches.end());
  if (stretches.empty()) {
    throw Exception(path + ": this bag has no gesture blocks (recorded positions) of a station");
  }
  for (const Stretch& stretch : stretches) {
    if (stretch.slices != stretches.front().slices || stretch.slices < 1 ||
        stretch.slices > std::size_t{tgr::kMaxSlices}) {
      throw Exception(path + ": the gesture block of tick " + std::to_string(stretch.first_tick) +
                      " has " + std::to_string(stretch.slices) +
                      " slices, allowed: " + std::to_string(stretches.front().slices) +
                      " as the first one, 1..." + std::to_string(tgr::kMaxSlices));
    }
  }
  return std::make_unique<RecordedPositions>(std::move(recording));
}

std::unique_ptr<tgr::GestureSource> readPositions(const std::string& path,
                                                  const std::string& station) {
  return tgr::readAhead(positionsOf(readRecording(path, station), path));
}

}  // namespace ergotic::bag
