// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/tick_watch.hpp"

#include <algorithm>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {

ERGOTIC_REALTIME bool TickWatch::look(std::int64_t now_ns, std::int64_t ticks) noexcept {
  if (!has_looked_) {
    has_looked_ = true;
    ticks_ = ticks;
    last_look_ns_ = last_move_ns_ = now_ns;
    return false;
  }
  const std::int64_t passed_ns = now_ns - last_look_ns_;
  last_look_ns_ = now_ns;
  if (const std::int64_t late_ns = passed_ns - interval_ns_; late_ns > period_ns_) {
    ++machine_stalls_;
    longest_stall_ns_ = std::max(longest_stall_ns_, late_ns);
  }
  if (ticks != ticks_) {
    ticks_ = ticks;
    last_move_ns_ = now_ns;
    silence_ns_ = 0;
    state_ = state_ == State::kWaiting ? State::kWatching : state_;
    return false;
  }
  silence_ns_ += std::min(passed_ns, interval_ns_);
  if (state_ != State::kWatching || silence_ns_ < period_ns_) {
    return false;
  }
  state_ = State::kOff;
  return true;
}

}  // namespace ergotic::tgr
