// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/shared_memory_driver.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

constexpr std::array<double, kMaxSlices> kNoForce{};

/// A device that is started together with the station may need a moment.
SharedSegment attachPatiently(const std::string& name) {
  constexpr std::int64_t kPatienceNs = 1'000'000'000;
  constexpr std::int64_t kPauseNs = 20'000'000;
  const std::int64_t deadline = rt::monotonicNs() + kPatienceNs;
  while (true) {
    try {
      return SharedSegment::attach(name);
    } catch (const DeviceError&) {
      const std::int64_t now = rt::monotonicNs();
      if (now >= deadline) {
        throw;
      }
      rt::sleepUntilNs(now + kPauseNs);
    }
  }
}

bool isAlive(const SharedDevice& device) noexcept {
  return device.device_pid != 0 &&
         rt::monotonicNs() - device.heartbeat_ns <= SharedMemoryDriver::kMissingNs;
}

bool isSame(const SharedTraits& a, const SharedTraits& b) noexcept {
  return a.slices == b.slices && a.is_raw == b.is_raw && a.step_rate_hz == b.step_rate_hz &&
         a.delay_s == b.delay_s && a.damping == b.damping;
}

/// Makes this process the driver, with zero force, the gesture at its start and nothing latched.
void takeOver(SharedDevice& device, const std::string& name) {
  std::int32_t owner = device.driver_pid;
  if (processLives(owner)) {
    throw DeviceError("virtual device " + name + ": process " + std::to_string(owner) +
                      " has it open");
  }
  if (!device.driver_pid.compare_exchange_strong(owner, ::getpid())) {
    throw DeviceError("virtual device " + name + ": another driver opens it at the same moment");
  }
  device.forces.write(kNoForce.data(), device.traits.slices);
  device.exchanges = 0;
  device.safe = 0;
  ++device.session;
}

}  // namespace

SharedMemoryDriver::SharedMemoryDriver(const VirtualDriverConfig& config)
    : name_(config.shared_memory), slices_(config.slices), is_raw_(config.is_raw) {
  requireWithin("slices", slices_, 1, kMaxSlices, "");
  if (!config.gesture_file.empty() || config.extra_delay_ticks != 0) {
    throw Exception("virtual device " + name_ +
                    ": gesture_file and extra_delay_ticks are settings of a device inside the "
                    "driver; give the gesture to virtual_tgr instead");
  }
}

SharedMemoryDriver::~SharedMemoryDriver() {
  close();
}

void SharedMemoryDriver::open(double tick_rate_hz) {
  close();
  SharedSegment segment = attachPatiently(name_);
  const SharedTraits& traits = segment->traits;
  if (traits.slices != slices_) {
    throw DeviceError("virtual device " + name_ + ": has " + std::to_string(traits.slices) +
                      " slices, not the " + std::to_string(slices_) + " that were asked for");
  }
  if (traits.is_raw != is_raw_) {
    throw DeviceError("virtual device " + name_ + ": speaks " +
                      (traits.is_raw ? "volts, allowed with: is_raw: true"
                                     : "metres, allowed with: is_raw: false"));
  }
  takeOver(*segment.get(), name_);
  traits_ = traits;
  constexpr double kStepsOfDelay = 2.0;
  extra_delay_ticks_ = static_cast<int>(
      std::ceil((kStepsOfDelay / traits.step_rate_hz + traits.delay_s) * tick_rate_hz));
  join(std::move(segment));
}

void SharedMemoryDriver::join(SharedSegment segment) {
  segments_.push_back(std::move(segment));
  SharedDevice* const device = segments_.back().get();
  device_ = device;
  if (safe_) {  // a makeSafe that came before the device was known
    device->safe = 1;
  }
  open_ = true;
}

void SharedMemoryDriver::reconnect() {
  if (!open_) {
    throw DeviceError("virtual device " + name_ + ": is not open");
  }
  SharedDevice& old = *device_.load();
  if (isAlive(old)) {
    return;
  }
  SharedSegment segment = SharedSegment::attach(name_);
  if (!isAlive(*segment.get())) {
    throw DeviceError("virtual device " + name_ + ": does not move; start it again");
  }
  if (segment->born_ns == old.born_ns) {
    return;  // it was only slow
  }
  if (!isSame(segment->traits, traits_)) {
    throw DeviceError("virtual device " + name_ +
                      ": is another one now: start the station again, or the device as it was");
  }
  takeOver(*segment.get(), name_);
  join(std::move(segment));
}

void SharedMemoryDriver::close() noexcept {
  if (open_.exchange(false)) {
    SharedDevice& device = *device_.load();
    device.forces.write(kNoForce.data(), slices_);
    device.driver_pid = 0;
  }
}

ERGOTIC_REALTIME std::uint32_t SharedMemoryDriver::exchange(const double* forces,
                                                            double* positions) noexcept {
  std::uint32_t flags = safe_ ? kMadeSafe : kExchangeOk;
  if (!open_) {
    flags |= kDeviceLost;
  } else {
    SharedDevice& device = *device_.load();
    if (device.safe != 0) {  // also set by the device's watchdog
      flags |= kMadeSafe;
    }
    const bool safe = (flags & kMadeSafe) != 0;
    device.forces.write(safe ? kNoForce.data() : forces, slices_);
    device.exchanges.fetch_add(1, std::memory_order_release);
    const std::int64_t age = rt::monotonicNs() - device.heartbeat_ns;
    if (device.device_pid == 0 || age > kLostNs) {
      flags |= kDeviceLost;
    } else if (!device.positions.read(last_positions_.data(), slices_) || age > kMissingNs) {
      flags |= kMissingSample;
    }
  }
  std::copy_n(last_positions_.begin(), slices_, positions);
  return flags;
}

void SharedMemoryDriver::makeSafe() noexcept {
  safe_ = true;
  if (SharedDevice* const device = device_; device != nullptr) {
    device->safe = 1;
  }
}

void SharedMemoryDriver::rearm() noexcept {
  safe_ = false;
  if (SharedDevice* const device = device_; device != nullptr) {
    device->safe = 0;
  }
}

/// Sessions are counted anew in each device: a later one of the same number was born later.
std::vector<Guard> SharedMemoryDriver::guards() const {
  const SharedDevice& device = *device_.load();
  const std::string born = std::to_string(device.born_ns);  // another may have taken its name
  return {{{"shared_memory", name_, born}, -1, device.born_ns + device.session}};
}

bool SharedMemoryDriver::move(const HandMove& move) noexcept {
  if (!move.isValid(slices_) || !open_) {
    return false;
  }
  SharedDevice& device = *device_.load();
  return device.moves.push(device.session, move);
}

}  // namespace ergotic::tgr
