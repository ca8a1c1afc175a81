// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_device.hpp"

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

const VirtualDeviceConfig& checked(const VirtualDeviceConfig& config) {
  if (!config.bank.shared_memory.empty() || config.bank.extra_delay_ticks != 0) {
    throw Exception(
        "shared_memory and extra_delay_ticks are settings of a driver, not of the device process");
  }
  if (!config.bank.gesture_file.empty() && config.bank.gesture_rate == 0.0 &&
      gestureKindOf(config.bank.gesture_file) == GestureKind::kPositions) {
    throw Exception(config.bank.gesture_file +
                    ": positions per tick need a gesture_rate: a device process knows no ticks");
  }
  requireWithin("rate", config.rate_hz, 100.0, 50'000.0, "Hz");
  requireWithin("watchdog", config.watchdog_s, 0.001, 10.0, "s");
  return config;
}

}  // namespace

VirtualDevice::VirtualDevice(const VirtualDeviceConfig& config)
    : config_(checked(config)),
      bank_(config.bank),
      shared_(SharedSegment::create(
          config.shared_memory,
          {bank_.slices(), bank_.isRaw(), config.rate_hz, bank_.delay(), bank_.damping()})),
      watchdog_ns_(static_cast<std::int64_t>(config.watchdog_s * kNsPerS)) {
  bank_.start(1.0 / config.rate_hz, config.rate_hz);
  shared_->heartbeat_ns = rt::monotonicNs();
}

ERGOTIC_REALTIME bool VirtualDevice::mayPush(std::int64_t now_ns) noexcept {
  if (const std::uint32_t session = shared_->session; session != session_) {
    session_ = session;
    exchanges_ = 0;
    heard_ = false;
    asked_.fill(0.0);
    bank_.restartGesture();
  }
  if (const std::uint64_t exchanges = shared_->exchanges; exchanges != exchanges_) {
    exchanges_ = exchanges;
    last_exchange_ns_ = now_ns;
    heard_ = true;
  }
  if (shared_->driver_pid == 0) {
    heard_ = false;
  } else if (heard_ && now_ns - last_exchange_ns_ > watchdog_ns_) {
    heard_ = false;
    shared_->safe = 1;
  }
  return heard_ && shared_->safe == 0;
}

ERGOTIC_REALTIME void VirtualDevice::takeForces(std::int64_t now_ns) noexcept {
  const bool may_push = mayPush(now_ns);
  if (may_push) {
    shared_->forces.read(asked_.data(), bank_.slices());  // they stand if the driver just writes
  }
  for (int i = 0; i < bank_.slices(); ++i) {
    const auto slot = static_cast<std::size_t>(i);
    const double force = may_push ? bank_.newtons(i, asked_[slot]) : 0.0;
    if (force != forces_[slot]) {
      forces_[slot] = force;
      if (!records_.push({now_ns, i, force})) {
        ++dropped_records_;
      }
    }
  }
}

ERGOTIC_REALTIME void VirtualDevice::step(std::int64_t now_ns) noexcept {
  takeForces(now_ns);
  HandMove move;
  while (shared_->moves.pop(session_, move)) {
    bank_.take(move);
  }
  bank_.step(forces_.data());
  std::array<double, kMaxSlices> positions{};
  bank_.read(positions.data());
  shared_->positions.write(positions.data(), bank_.slices());
  shared_->heartbeat_ns = now_ns;
}

void VirtualDevice::run(const std::atomic<bool>& stop) noexcept {
  const double period_ns = kNsPerS / config_.rate_hz;
  std::int64_t start_ns = rt::monotonicNs();
  for (std::int64_t n = 0; !stop; ++n) {
    const std::int64_t due_ns =
        start_ns + static_cast<std::int64_t>(static_cast<double>(n) * period_ns);
    rt::sleepUntilNs(due_ns);
    const std::int64_t now_ns = rt::monotonicNs();
    if (now_ns - due_ns > kMaxBehindNs) {
      start_ns = now_ns;
      n = 0;
    }
    step(now_ns);
  }
}

}  // namespace ergotic::tgr
