// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/gesture_blocks.hpp"

#include <algorithm>
#include <utility>

namespace ergotic::node {

// The message carries the station's flags as they are.
static_assert(GestureBlock::CATCH_UP == std::uint32_t{station::GestureTick::kCatchUp});
static_assert(GestureBlock::HELD == std::uint32_t{station::GestureTick::kHeld});
static_assert(GestureBlock::AUDIO_INPUT == std::uint32_t{station::GestureTick::kAudioInput});

GestureBlocks::GestureBlocks(double tick_rate_hz)
    : tick_rate_hz_(tick_rate_hz),
      ticks_per_block_(std::clamp(
          static_cast<std::uint32_t>(kMaxLengthS * tick_rate_hz), std::uint32_t{1}, kMaxTicks)) {}

std::optional<GestureBlock> GestureBlocks::add(const station::GestureTick& tick) {
  std::optional<GestureBlock> finished;
  const bool follows = tick.tick == block_.first_tick + block_.ticks &&
                       tick.slices == block_.slices && tick.ports == block_.ports;
  if (block_.ticks > 0 && !follows) {
    finished = take();
  }
  if (block_.ticks == 0) {
    block_.first_tick = tick.tick;
    block_.slices = tick.slices;
    block_.ports = tick.ports;
  }
  block_.flags.push_back(tick.flags);
  block_.positions.insert(block_.positions.end(), tick.position.begin(),
                          tick.position.begin() + tick.slices);
  block_.forces.insert(block_.forces.end(), tick.force.begin(), tick.force.begin() + tick.slices);
  block_.port_positions.insert(block_.port_positions.end(), tick.port.begin(),
                               tick.port.begin() + tick.ports);
  ++block_.ticks;
  if (!finished && block_.ticks >= ticks_per_block_) {
    finished = take();
  }
  return finished;
}

GestureBlock GestureBlocks::take() {
  block_.tick_rate_hz = tick_rate_hz_;
  return std::exchange(block_, GestureBlock());
}

}  // namespace ergotic::node
