// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <mutex>

#include <ergotic/GestureBlock.h>
#include <ros/ros.h>

#include "integration/gesture_record.hpp"

namespace ergotic::test {

/// When force was there last, in the ticks of a station.
class ForceWatch {
 public:
  explicit ForceWatch(::ros::NodeHandle& node) {
    blocks_ = node.subscribe<GestureBlock>("/station/gesture", 10000,
                                           [this](const auto& block) { take(*block); });
  }

  /// When the last tick with a force was due, CLOCK_MONOTONIC.
  std::int64_t lastForceNs() const {
    const std::lock_guard lock(mutex_);
    return last_force_ < 0 ? 0 : dueNs(last_force_);
  }
  /// Until when all is known.
  std::int64_t knownNs() const {
    const std::lock_guard lock(mutex_);
    return newest_ < 0 ? 0 : dueNs(newest_);
  }

 private:
  std::int64_t dueNs(std::int64_t tick) const {
    return first_ns_ + static_cast<std::int64_t>(1e9 * static_cast<double>(tick) / rate_hz_);
  }
  /// No block is stamped before its first tick: the earliest stamp tells best when ticks are due.
  void take(const GestureBlock& block) {
    const std::lock_guard lock(mutex_);
    rate_hz_ = block.tick_rate_hz;
    const std::int64_t stamp_ns =
        static_cast<std::int64_t>(block.header.stamp.toNSec()) - wallLessMonotonicNs();
    first_ns_ =
        std::min(first_ns_, stamp_ns - static_cast<std::int64_t>(
                                           1e9 * static_cast<double>(block.first_tick) / rate_hz_));
    for (std::uint32_t i = 0; i < block.ticks; ++i) {
      const auto first = block.forces.begin() + static_cast<std::ptrdiff_t>(i * block.slices);
      if (std::any_of(first, first + block.slices, [](float force) { return force != 0.0F; })) {
        last_force_ = block.first_tick + i;
      }
    }
    newest_ = block.first_tick + block.ticks - 1;
  }

  mutable std::mutex mutex_;
  double rate_hz_ = 1.0;
  std::int64_t first_ns_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_force_ = -1;
  std::int64_t newest_ = -1;
  ::ros::Subscriber blocks_;
};

}  // namespace ergotic::test
