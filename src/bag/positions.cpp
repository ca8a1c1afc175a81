// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/bag/positions.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "ergotic/bag/recording.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::bag {
namespace {

class RecordedPositions : public tgr::GestureSource {
 public:
  explicit RecordedPositions(std::vector<Block> blocks)
      : blocks_(std::move(blocks)), tick_(blocks_.front().first_tick) {}

  int slices() const noexcept override { return static_cast<int>(blocks_.front().slices); }

  bool next(double* positions) noexcept override {
    while (block_ < blocks_.size() && tick_ >= blocks_[block_].endTick()) {
      ++block_;
    }
    if (block_ == blocks_.size()) {
      return false;
    }
    // Between two blocks the last tick of the one before is held.
    const Block& block = tick_ < blocks_[block_].first_tick ? blocks_[block_ - 1] : blocks_[block_];
    const std::int64_t row = std::min(tick_, block.endTick() - 1) - block.first_tick;
    std::copy_n(block.positions.begin() + row * static_cast<std::ptrdiff_t>(block.slices),
                block.slices, positions);
    ++tick_;
    return true;
  }

 private:
  std::vector<Block> blocks_;  // none of them empty
  std::size_t block_ = 0;
  std::int64_t tick_;
};

}  // namespace

std::unique_ptr<tgr::GestureSource> readPositions(const std::string& path) {
  std::vector<Block> blocks = readRecording(path).blocks;
  blocks.erase(std::remove_if(blocks.begin(), blocks.end(),
                              [](const Block& block) { return block.flags.empty(); }),
               blocks.end());
  if (blocks.empty()) {
    throw Exception(path + ": no gesture of a station in this bag");
  }
  for (const Block& block : blocks) {
    if (block.slices != blocks.front().slices || block.slices < 1 ||
        block.slices > std::size_t{tgr::kMaxSlices}) {
      throw Exception(path + ": the gesture block of tick " + std::to_string(block.first_tick) +
                      " has " + std::to_string(block.slices) +
                      " slices, allowed: " + std::to_string(blocks.front().slices) +
                      " as the first one, 1..." + std::to_string(tgr::kMaxSlices));
    }
  }
  return std::make_unique<RecordedPositions>(std::move(blocks));
}

}  // namespace ergotic::bag
