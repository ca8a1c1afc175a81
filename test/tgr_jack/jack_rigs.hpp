// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <thread>

#include "ergotic/audio/jack_client.hpp"
#include "ergotic/tgr/driver.hpp"
#include "support/jack_server.hpp"
#include "support/period_probe.hpp"
#include "support/test.hpp"
#include "tgr/drivers/jack/jack_device.hpp"
#include "tgr/drivers/jack/jack_driver.hpp"
#include "tgr/drivers/jack/jack_settings.hpp"

/// A driver and its device as two clients of a real JACK server.
namespace ergotic::test {

constexpr int kJackSlices = 3;
constexpr int kJackRate = 48000;           // Hz
constexpr std::uint32_t kJackPeriod = 64;  // frames

/// A slice that moves by force alone and is seen as it is.
inline tgr::VirtualSliceConfig bareSlice() {
  tgr::VirtualSliceConfig slice;
  slice.dry_friction = 0.0;
  slice.quantum = 0.0;
  slice.noise_rms = 0.0;
  slice.bandwidth = std::numeric_limits<double>::infinity();
  return slice;
}

inline tgr::JackDeviceConfig jackDevice(int slices = kJackSlices) {
  tgr::JackDeviceConfig config;
  config.bank.slices = slices;
  config.bank.slice = bareSlice();
  return config;
}

/// Of a driver wired to the ports of a client that JackDevice::jackConfig described.
inline tgr::JackDriverConfig jackDriver(const JackServer& server, int slices = kJackSlices) {
  tgr::JackDriverConfig config;
  config.server = server.name();
  for (int i = 1; i <= slices; ++i) {
    config.position_ports.push_back("device:position_" + std::to_string(i));
    config.force_ports.push_back("device:force_" + std::to_string(i));
  }
  config.wait_s = 30.0;  // a busy machine is slow
  return config;
}

inline JackServer::Settings serverSettings(int rate, int period) {
  JackServer::Settings settings;
  settings.sample_rate = rate;
  settings.period_frames = period;
  return settings;
}

/// A virtual device as a client of a server.
class JackDeviceClient {
 public:
  JackDeviceClient(const JackServer& server, const tgr::JackDeviceConfig& config)
      : device(config), host_(device.jackConfig("device", server.name()), device) {}

  tgr::JackDevice device;

 private:
  audio::JackHost host_;
};

/// Ticks a driver, and counts what it meets.
class TickCounter : public tgr::TickTarget {
 public:
  explicit TickCounter(tgr::Driver& driver) : driver_(driver) {}

  void tick(std::int64_t late_ns) noexcept override {
    (void)late_ns;
    const std::uint32_t met = driver_.exchange(forces_.data(), positions_.data());
    lost += (met & tgr::kDeviceLost) != 0 ? 1 : 0;
    well += met == tgr::kExchangeOk ? 1 : 0;
    computeForces(ticks);
    ++ticks;
  }
  void missed(std::int64_t count, std::int64_t stall_ns) noexcept override {
    std::array<double, tgr::kMaxSlices> no_force{};
    driver_.exchange(no_force.data(), positions_.data());
    missed_ticks += count;
    stalls_ns += stall_ns;
  }

  std::atomic<std::int64_t> ticks{0};
  std::atomic<std::int64_t> well{0};
  std::atomic<std::int64_t> lost{0};
  std::atomic<std::int64_t> missed_ticks{0};
  std::atomic<std::int64_t> stalls_ns{0};

 protected:
  /// Fills forces_, which go out with the next tick.
  virtual void computeForces(std::int64_t /*tick*/) noexcept {}

  tgr::Driver& driver_;
  std::array<double, tgr::kMaxSlices> forces_{};
  std::array<double, tgr::kMaxSlices> positions_{};
};

/// A driver with a clock of its own, exchanged from a thread that has none: an exchange takes place
/// in the next tick, and ticks in between are without force: none may go out between a `rearm` and
/// the exchange after it.
class TickedDriver final : public tgr::Driver, private tgr::TickTarget {
 public:
  explicit TickedDriver(std::unique_ptr<tgr::Driver> inside) : inside_(std::move(inside)) {}
  ~TickedDriver() override { close(); }
  TickedDriver(const TickedDriver&) = delete;
  TickedDriver& operator=(const TickedDriver&) = delete;

  void open(double tick_rate_hz) override {
    close();
    inside_->open(tick_rate_hz);
    inside_->clock()->start(*this);
    open_ = true;
  }
  void close() noexcept override {
    inside_->clock()->stop();
    inside_->close();
    open_ = false;
  }
  int slices() const noexcept override { return inside_->slices(); }
  std::uint32_t exchange(const double* forces, double* positions) noexcept override {
    if (!open_) {
      return inside_->exchange(forces, positions);
    }
    std::copy_n(forces, slices(), asked_.begin());
    is_asked_ = true;
    if (!eventually([this] { return !is_asked_; })) {
      return tgr::kDeviceLost;
    }
    std::copy_n(positions_.begin(), slices(), positions);
    return met_;
  }
  void makeSafe() noexcept override { inside_->makeSafe(); }
  void rearm() noexcept override { inside_->rearm(); }
  int extraDelayTicks() const noexcept override { return inside_->extraDelayTicks(); }

 private:
  void tick(std::int64_t /*late_ns*/) noexcept override {
    const bool asked = is_asked_;
    const std::array<double, tgr::kMaxSlices> no_force{};
    std::array<double, tgr::kMaxSlices> positions{};
    const std::uint32_t met =
        inside_->exchange(asked ? asked_.data() : no_force.data(), positions.data());
    if (asked) {
      positions_ = positions;
      met_ = met;
      is_asked_ = false;
    }
  }
  void missed(std::int64_t /*ticks*/, std::int64_t /*stall_ns*/) noexcept override {}

  std::unique_ptr<tgr::Driver> inside_;
  bool open_ = false;
  std::array<double, tgr::kMaxSlices> asked_{};
  std::array<double, tgr::kMaxSlices> positions_{};
  std::uint32_t met_ = 0;
  std::atomic<bool> is_asked_{false};
};

}  // namespace ergotic::test
