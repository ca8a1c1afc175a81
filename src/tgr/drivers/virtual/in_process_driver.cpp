// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/in_process_driver.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {

InProcessDriver::InProcessDriver(const VirtualDriverConfig& config)
    : bank_(config),
      values_(readGestureValues(config.gesture_file)),
      queue_ticks_(config.extra_delay_ticks) {
  requireWithin("extra_delay_ticks", queue_ticks_, 0, kMaxExtraDelayTicks, "ticks");
}

void InProcessDriver::open(double tick_rate_hz) {
  bank_.start(1.0 / tick_rate_hz, tick_rate_hz);
  gesture_s_ = 0.0;
  actuator_ticks_ = static_cast<int>(std::ceil(bank_.delay() * tick_rate_hz));
  for (Forces& forces : queue_) {
    forces.fill(0.0);
  }
  head_ = 0;
  last_positions_.fill(0.0);
  open_ = true;
}

ERGOTIC_REALTIME std::uint32_t InProcessDriver::exchange(const double* forces,
                                                         double* positions) noexcept {
  const bool safe = safe_;
  const std::uint32_t made_safe = safe ? kMadeSafe : kExchangeOk;
  if (!open_) {
    std::copy_n(last_positions_.begin(), slices(), positions);
    return made_safe | kDeviceLost;
  }
  if (safe) {  // also what is under way
    for (Forces& queued : queue_) {
      queued.fill(0.0);
    }
  }
  takeMoves();
  Forces& oldest = queue_[head_];
  bank_.step(oldest.data());
  gesture_s_.store(bank_.gestureTime(), std::memory_order_relaxed);
  bank_.read(last_positions_.data());
  for (int i = 0; i < slices(); ++i) {
    oldest[static_cast<std::size_t>(i)] = bank_.newtons(i, safe ? 0.0 : forces[i]);
  }
  head_ = (head_ + 1) % static_cast<std::size_t>(queue_ticks_ + 1);
  std::copy_n(last_positions_.begin(), slices(), positions);
  return made_safe;
}

ERGOTIC_REALTIME void InProcessDriver::takeMoves() noexcept {
  HandMove move;
  for (std::size_t i = 0; i < kPendingMoves && moves_.pop(move); ++i) {
    bank_.take(move);
  }
}

bool InProcessDriver::move(const HandMove& move) noexcept {
  return move.isValid(slices()) && moves_.push(move);
}

}  // namespace ergotic::tgr
