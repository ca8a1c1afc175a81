// SPDX-License-Identifier: BSD-3-Clause
// What takes the force from the hand, beside the safety chain.
#include <algorithm>
#include <cmath>
#include <limits>

#include "ergotic/station/station.hpp"

namespace ergotic::station {

/// A slice in use that has no calibration takes the force from all.
void Station::followCalibration() noexcept {
  const std::uint64_t used = performer_->rig->slicesInUse();
  const std::uint64_t uncalibrated = driver_->uncalibrated();
  chain_.setInUse(used & ~uncalibrated);
  interlock_->setCalibrated((used & uncalibrated) == 0);
  followInterlock();
}

/// Follows the deadman switch, which has to be reported again and again: a program that hangs
/// releases it.
void Station::followPresence() noexcept {
  if (presence_ticks_ == 0) {
    return;
  }
  if (const unsigned told = told_presence_.exchange(0); told != 0) {
    present_ = (told & kLetGo) == 0;
    absent_ = 0;
  }
  if (present_ && ++absent_ > presence_ticks_) {
    present_ = false;
  }
  if (!present_ && hasForce()) {
    fault(FaultReason::kPresence, -1);
  }
}

void Station::injectModelFault() noexcept {
  if (inject_ticks_ == 0) {
    return;
  }
  constexpr double kBlowUpN = 1.0;
  constexpr double kActiveNPerM = 1e4;
  --inject_ticks_;
  for (std::size_t s = 0; s < static_cast<std::size_t>(slices_); ++s) {
    switch (injected_) {
      case InjectedModelFault::kNotANumber:
        force_[s] = std::numeric_limits<double>::quiet_NaN();
        break;
      case InjectedModelFault::kBlowUp:
        force_[s] +=
            std::ldexp(kBlowUpN, static_cast<int>(std::min<std::int64_t>(inject_age_, 1000)));
        break;
      case InjectedModelFault::kActive:
        force_[s] += kActiveNPerM * (position_[s] - inject_from_[s]);
        break;
    }
  }
  ++inject_age_;
}

bool Station::hasForce() const noexcept {
  return interlock_->read().isOpen();
}

/// Force that was there is gone, and comes back in a ramp. Often, that is a hand that is shaken.
bool Station::isKickedTooOften() noexcept {
  const double passed_s = 1e-9 * tick_ns_ * static_cast<double>(tick_ - kick_tick_);
  kicks_ = std::max(0.0, kicks_ - config_.max_stalls * passed_s) + 1.0;
  kick_tick_ = tick_;
  return kicks_ > config_.max_stalls;
}

/// \param stall_s  of the thread; 0: a tick was not whole in time
void Station::kick(double stall_s) noexcept {
  if (hasForce() && isKickedTooOften()) {
    stall_s_ = stall_s;
    stalls_borne_ = static_cast<std::uint64_t>(config_.max_stalls);
    fault(FaultReason::kStall, -1);
  }
}

void Station::kick(FaultReason reason, int slice) noexcept {
  if (hasForce() && isKickedTooOften()) {
    fault(reason, slice);
  }
}

/// Force may have been taken away by any thread, this one as well.
void Station::followInterlock() noexcept {
  const Interlock::Reading now = interlock_->read();
  if (now.ticket == seen_) {
    return;
  }
  seen_ = now.ticket;
  takeForceAway();
  if (!now.isLatched()) {
    tell(event(Event::Type::kStopped));
  } else if (!is_latched_) {
    is_latched_ = true;
    Event told = event(Event::Type::kFault);
    told.index = static_cast<std::int64_t>(now.reason);
    const bool is_stall = now.reason == FaultReason::kStall;
    told.value = is_stall ? stall_s_ : fault_slice_;
    told.id = is_stall ? stalls_borne_ : 0;
    tell(told);
  }
}

void Station::takeForceAway() noexcept {
  chain_.disengage();
  force_.fill(0.0);
}

/// Reports a fault. Only the first reason is reported; later ones find the force latched at zero.
void Station::fault(FaultReason reason, int slice) noexcept {
  takeForceAway();
  if (interlock_->read().isLatched()) {
    return;
  }
  if (reason == FaultReason::kWriteFailed || reason == FaultReason::kDeviceLost) {
    driver_->makeSafeInTick();  // the zero of the next exchange may not arrive either
  }
  fault_slice_ = slice;
  interlock_->latch(reason);
  followInterlock();
  fault_slice_ = -1;
}

}  // namespace ergotic::station
