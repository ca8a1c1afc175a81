// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/device_source.hpp"

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::station {
namespace {

tgr::DeviceClock& clockOf(tgr::Driver& driver) {
  tgr::DeviceClock* const clock = driver.clock();
  if (clock == nullptr) {
    throw Exception("the device has no clock of its own: ticks have to come from the timer");
  }
  return *clock;
}

}  // namespace

DeviceSource::DeviceSource(Station& station, AudioBridge* bridge)
    : station_(station), bridge_(bridge), clock_(clockOf(station.driver())) {}

void DeviceSource::start(bool lock_memory) {
  if (running_) {
    throw Exception("the device already ticks");
  }
  warnings_.clear();
  if (lock_memory) {
    const rt::Outcome locked = rt::lockMemory();
    if (!locked.ok) {
      warnings_.push_back(locked.message);
    }
  }
  running_ = true;
  clock_.start(*this);
}

void DeviceSource::stop() noexcept {
  if (!running_) {
    return;
  }
  clock_.stop();
  running_ = false;
  station_.rest();
  if (bridge_ != nullptr) {
    bridge_->disconnect();
  }
}

void DeviceSource::tick(std::int64_t late_ns) noexcept {
  follow(rt::monotonicNs() - late_ns);
  station_.cycle({late_ns, false});
}

void DeviceSource::missed(std::int64_t ticks, std::int64_t stall_ns) noexcept {
  follow(rt::monotonicNs() - stall_ns);
  station_.catchUp(ticks, stall_ns);
}

/// The host's clock is listened to only to find out which of its frames are ours.
void DeviceSource::follow(std::int64_t due_ns) noexcept {
  if (bridge_ != nullptr) {
    bridge_->track(station_.nextTick(), due_ns);
  }
}

}  // namespace ergotic::station
