// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ergotic/GestureBlock.h>
#include <ros/node_handle.h>

#include "ergotic/rt/clock.hpp"
#include "integration/listener.hpp"
#include "support/test.hpp"

namespace ergotic::test {

/// Wall time less CLOCK_MONOTONIC. What comes between two readings makes it smaller, never larger.
inline std::int64_t wallLessMonotonicNs() {
  constexpr int kReadings = 10;
  std::int64_t most = std::numeric_limits<std::int64_t>::min();
  for (int i = 0; i < kReadings; ++i) {
    const std::chrono::nanoseconds wall = std::chrono::system_clock::now().time_since_epoch();
    most = std::max(most, wall.count() - rt::monotonicNs());
  }
  return most;
}

/// What a station under its own timer tells of its ticks, from here on.
class GestureRecord {
 public:
  explicit GestureRecord(::ros::NodeHandle& node) : blocks_(node, "/station/gesture") {}

  struct Tick {
    std::int64_t tick = 0;
    std::vector<double> positions;  ///< [slices] m
  };
  /// Those that came, from `tick` on.
  std::vector<Tick> from(std::int64_t tick) const {
    std::vector<Tick> ticks;
    for (const GestureBlock& block : blocks_.messages()) {
      auto first = block.positions.begin();
      for (std::uint32_t i = 0; i < block.ticks; ++i, first += block.slices) {
        if (block.first_tick + i >= tick) {
          ticks.push_back({block.first_tick + i, {first, first + block.slices}});
        }
      }
    }
    return ticks;
  }

  /// When a tick was due, CLOCK_MONOTONIC. Ticks are due in equal steps, and no block is stamped
  /// before its first one: the earliest stamp, less the steps up to it, tells best.
  /// \pre a block came
  std::int64_t dueNs(std::int64_t tick) const {
    constexpr double kNsPerS = 1e9;
    std::int64_t due = std::numeric_limits<std::int64_t>::max();
    for (const GestureBlock& block : blocks_.messages()) {
      const double steps = static_cast<double>(tick - block.first_tick) / block.tick_rate_hz;
      due = std::min(due, static_cast<std::int64_t>(block.header.stamp.toNSec()) +
                              static_cast<std::int64_t>(kNsPerS * steps));
    }
    return due - wallLessMonotonicNs();
  }

  /// \pre a block came
  std::int64_t newest() const {
    const GestureBlock block = blocks_.latest();
    return block.first_tick + block.ticks - 1;
  }
  std::size_t count() const { return blocks_.count(); }

 private:
  Listener<GestureBlock> blocks_;
};

}  // namespace ergotic::test
