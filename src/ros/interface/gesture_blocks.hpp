// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <ergotic/GestureBlock.h>

#include "ergotic/station/messages.hpp"

namespace ergotic::node {

/// Gathers ticks into messages: one message per tick would drown a recorder.
class GestureBlocks {
 public:
  static constexpr std::uint32_t kMaxTicks = 64;
  static constexpr double kMaxLengthS = 0.02;

  explicit GestureBlocks(double tick_rate_hz);

  /// \return the block that is finished by this tick: full, or broken off by a gap before it
  std::optional<GestureBlock> add(const station::GestureTick& tick);

  std::uint32_t ticksPerBlock() const { return ticks_per_block_; }

 private:
  GestureBlock take();

  double tick_rate_hz_;
  std::uint32_t ticks_per_block_;
  GestureBlock block_;
};

}  // namespace ergotic::node
