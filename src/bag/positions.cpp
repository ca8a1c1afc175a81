// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/bag/positions.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "bag/recorded_message.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::bag {
namespace {

class RecordedPositions : public tgr::GestureSource {
 public:
  explicit RecordedPositions(std::vector<Stretch> stretches)
      : stretches_(std::move(stretches)), tick_(stretches_.front().first_tick) {}

  int slices() const noexcept override { return static_cast<int>(stretches_.front().slices); }

  bool next(double* positions) noexcept override {
    while (stretch_ < stretches_.size() && tick_ >= stretches_[stretch_].endTick()) {
      ++stretch_;
    }
    if (stretch_ == stretches_.size()) {
      return false;
    }
    // Between two stretches the last tick of the one before is held.
    const Stretch& stretch =
        tick_ < stretches_[stretch_].first_tick ? stretches_[stretch_ - 1] : stretches_[stretch_];
    const std::int64_t row = std::min(tick_, stretch.endTick() - 1) - stretch.first_tick;
    std::copy_n(stretch.positions.begin() + row * static_cast<std::ptrdiff_t>(stretch.slices),
                stretch.slices, positions);
    ++tick_;
    return true;
  }

 private:
  std::vector<Stretch> stretches_;  // none of them empty
  std::size_t stretch_ = 0;
  std::int64_t tick_;
};

}  // namespace

std::unique_ptr<tgr::GestureSource> positionsOf(std::vector<Stretch> stretches,
                                                const std::string& path) {
  stretches.erase(std::remove_if(stretches.begin(), stretches.end(),
                                 [](const Stretch& stretch) { return stretch.flags.empty(); }),
                  stretches.end());
  if (stretches.empty()) {
    throw Exception(path + ": no gesture of a station in this bag");
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
  return std::make_unique<RecordedPositions>(std::move(stretches));
}

std::unique_ptr<tgr::GestureSource> readPositions(const std::string& path,
                                                  const std::string& station) {
  Recording recording = readRecording(path, station);
  for (Stretch& stretch : recording.stretches) {
    recording.load(stretch);
    stretch.ports_at = {};
  }
  return positionsOf(std::move(recording.stretches), path);
}

}  // namespace ergotic::bag
