// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "ergotic/rt/mailbox.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/tgr/calibration.hpp"

namespace ergotic::tgr {

/// A small push of one slice: the operator asks for it, the tick executes it and reports the
/// result. It ends by itself, and for good when the device may give no force.
class SlicePush {
 public:
  /// \param delay_ticks  from the exchange that gets a force to the first position that shows it
  /// Thread: setup
  void open(double tick_s, int delay_ticks) {
    tick_s_ = tick_s;
    rest_ticks_ = static_cast<int>(std::ceil(kRestS / tick_s));
    delay_ticks_ = delay_ticks;
  }

  // Thread: operator

  void begin(int slice, double newtons) noexcept { order({++number_, slice, newtons}); }
  void end() noexcept { order({++number_, kNone, 0.0}); }
  /// Result of the push that was begun last, returned once.
  std::optional<Push> take() noexcept {
    const bool is_new = told_.refresh() && told_.latest().number == number_;
    return is_new ? std::optional(told_.latest().push) : std::nullopt;
  }

  // Thread: tick. Realtime: yes

  /// \return the slice to push with this exchange, -1: none
  ERGOTIC_REALTIME int slice() noexcept {
    if (orders_.refresh()) {
      ticks_ = 0;
      slice_ = orders_.latest().slice;
    }
    return slice_;
  }
  /// The force for this exchange, N: of a ramp, so that too large a gain moves the slice before it
  /// is strong. The slice is looked at before, whether it rests.
  ERGOTIC_REALTIME double force() const noexcept {
    constexpr double kMiddle = 0.5;  // of the tick for which it is held
    const double share = (ticks_ - rest_ticks_ + kMiddle) * tick_s_ / kPushS;
    return orders_.latest().newtons * std::clamp(share, 0.0, 1.0);
  }
  /// \param position     that came with this exchange, m
  /// \param may_go_on    whether the device is there and not made safe
  ERGOTIC_REALTIME void follow(double position, bool may_go_on) noexcept {
    if (!may_go_on || !std::isfinite(position)) {
      return finish({});
    }
    from_ = ticks_ == 0 ? position : from_;
    const double moved = position - from_;
    const int pushed = ++ticks_ - rest_ticks_ - delay_ticks_;  // that the position can know of
    if (pushed <= 0) {
      return std::abs(moved) > kRestM ? finish({0.0, moved, 0.0}) : void();
    }
    const double seconds = tick_s_ * pushed;
    if (seconds >= kPushS || std::abs(moved) >= kPushM) {
      finish({orders_.latest().newtons, moved, seconds});
    }
  }

 private:
  static constexpr int kNone = -1;
  struct Order {
    std::uint32_t number = 0;
    int slice = kNone;
    double newtons = 0.0;
  };
  struct Told {
    std::uint32_t number = 0;
    Push push;
  };

  void order(const Order& next) noexcept {
    orders_.draft() = next;
    orders_.publish();
  }
  ERGOTIC_REALTIME void finish(const Push& push) noexcept {
    told_.draft() = {orders_.latest().number, push};
    told_.publish();
    slice_ = kNone;
  }

  std::uint32_t number_ = 0;  // the operator's: of its last order
  rt::Mailbox<Order> orders_;
  rt::Mailbox<Told> told_;

  // The tick's own.
  double tick_s_ = 0.001;
  int rest_ticks_ = 1;
  int delay_ticks_ = 1;
  int slice_ = kNone;
  int ticks_ = 0;
  double from_ = 0.0;  // m
};

}  // namespace ergotic::tgr
