// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/interlock.hpp"

#include "ergotic/rt/realtime.hpp"

namespace ergotic::station {
namespace {

constexpr unsigned kByte = 8;
constexpr unsigned kMask = 0xFF;

}  // namespace

ERGOTIC_REALTIME Interlock::Word Interlock::packed(const Reading& reading) noexcept {
  return reading.ticket << 2U * kByte | static_cast<Word>(reading.state) << kByte |
         static_cast<Word>(reading.reason);
}

ERGOTIC_REALTIME Interlock::Reading Interlock::unpacked(Word word) noexcept {
  return {word >> 2U * kByte, static_cast<ForceState>(word >> kByte & kMask),
          static_cast<FaultReason>(word & kMask)};
}

// Tried again only when somebody else succeeded, and those are few.
template <class Change>
ERGOTIC_REALTIME bool Interlock::update(Change change) noexcept {
  Word word = word_;
  for (;;) {
    Reading reading = unpacked(word);
    if (!change(reading)) {
      return false;
    }
    if (word_.compare_exchange_weak(word, packed(reading))) {
      return true;
    }
  }
}

ERGOTIC_REALTIME void Interlock::stop() noexcept {
  update([](Reading& now) {
    ++now.ticket;
    now.state = now.isOpen() ? ForceState::kReady : now.state;
    return true;
  });
}

ERGOTIC_REALTIME void Interlock::latch(FaultReason reason) noexcept {
  update([reason](Reading& now) {
    ++now.ticket;
    now.reason = now.isLatched() ? now.reason : reason;
    now.state = ForceState::kFault;
    return true;
  });
}

ERGOTIC_REALTIME void Interlock::setCalibrated(bool is_calibrated) noexcept {
  update([is_calibrated](Reading& now) {
    const bool was = now.state != ForceState::kUncalibrated;
    if (now.isLatched() || was == is_calibrated) {
      return false;
    }
    now.ticket += is_calibrated ? 0U : 1U;
    now.state = is_calibrated ? ForceState::kReady : ForceState::kUncalibrated;
    return true;
  });
}

ERGOTIC_REALTIME bool Interlock::engage(Ticket asked) noexcept {
  return update([asked](Reading& now) {
    const bool may = now.state == ForceState::kReady || now.isOpen();
    now.state = ForceState::kEngaging;
    return may && now.ticket == asked;
  });
}

ERGOTIC_REALTIME bool Interlock::play() noexcept {
  return update([](Reading& now) {
    const bool ramps = now.state == ForceState::kEngaging;
    now.state = ForceState::kPlaying;
    return ramps;
  });
}

ERGOTIC_REALTIME bool Interlock::recover(Ticket asked) noexcept {
  return update([asked](Reading& now) {
    const bool may = now.ticket == asked;
    now.state = ForceState::kReady;
    now.reason = FaultReason::kNone;
    return may;
  });
}

}  // namespace ergotic::station
