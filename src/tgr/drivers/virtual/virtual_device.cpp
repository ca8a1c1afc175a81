// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_device.hpp"

#include <limits>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kNsPerS = 1e9;

const VirtualDeviceConfig& checked(const VirtualDeviceConfig& config) {
  requireWithin("rate", config.rate_hz, 100.0, 50'000.0, "Hz");
  requireWithin("watchdog", config.watchdog_s, 0.001, 10.0, "s");
  return config;
}

}  // namespace

VirtualDevice::VirtualDevice(const VirtualDeviceConfig& config)
    : config_(checked(config)),
      bank_(config.bank),
      shared_(SharedSegment::create(config.shared_memory, bank_.slices(), config.rate_hz)),
      watchdog_ns_(static_cast<std::int64_t>(config.watchdog_s * kNsPerS)) {
  bank_.start(1.0 / config.rate_hz);
  shared_->heartbeat_ns = rt::monotonicNs();
}

ERGOTIC_REALTIME bool VirtualDevice::mayPush(std::int64_t now_ns) noexcept {
  if (const std::uint32_t session = shared_->session; session != session_) {
    session_ = session;
    exchanges_ = 0;
    heard_ = false;
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
  std::array<double, kMaxSlices> felt{};
  if (mayPush(now_ns)) {
    felt = forces_;  // stands if the driver is just writing
    shared_->forces.read(felt.data(), bank_.slices());
  }
  for (int i = 0; i < bank_.slices(); ++i) {
    const auto slot = static_cast<std::size_t>(i);
    const double force = saturated(felt[slot], config_.bank.slice.force_limit);
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
  for (int i = 0; i < bank_.slices(); ++i) {
    bank_.setTarget(i, shared_->targets[static_cast<std::size_t>(i)]);
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

void drainForces(VirtualDevice& device, std::ostream& out) {
  out.precision(std::numeric_limits<double>::max_digits10);
  ForceRecord record;
  while (device.pollForce(record)) {
    out << record.time_ns << ',' << record.slice << ',' << record.force_n << '\n';
  }
}

}  // namespace ergotic::tgr
