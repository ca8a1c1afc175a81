// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/tgr/calibration.hpp"
#include "ergotic/tgr/driver.hpp"
#include "support/test.hpp"

namespace ergotic::test {

/// A device of which a test says all it does and sees all it gets, also when it is deep inside
/// others: both are in a `Script` that the test keeps.
struct Script {
  int slices = 2;
  bool is_raw = false;
  bool has_clock = false;
  bool opens = true;
  bool reconnects = true;
  int extra_delay_ticks = 0;
  double damping = 2.0;
  bool can_hurt = true;
  bool is_stepped_by_exchange = false;
  std::uint64_t uncalibrated = 0;
  std::uint32_t flags = 0;
  std::array<double, tgr::kMaxSlices> positions{};

  std::array<double, tgr::kMaxSlices> forces{};  ///< of the last exchange
  int exchanges = 0;
  bool is_open = false;
  bool is_safe = false;
  int reconnections = 0;
  std::pair<int, double> target{-1, 0.0};
};

/// 1 V is 5 mm from 2 V on; 1 N is -0.05 V.
inline tgr::SliceCalibration someCalibration() {
  tgr::SliceCalibration c;
  c.is_calibrated = true;
  c.metres_per_volt = 0.005;
  c.rest_volts = 2.0;
  c.low_volts = -5.0;
  c.high_volts = 8.0;
  c.volts_per_newton = -0.05;
  c.zero_volts = 0.004;
  c.max_volts = 4.0;
  return c;
}

class ScriptedDevice final : public tgr::Driver, private tgr::DeviceClock {
 public:
  explicit ScriptedDevice(Script& script) : script_(script) {}

  void open(double) override {
    if (!script_.opens) {
      throw DeviceError("it does not open");
    }
    script_.is_open = true;
  }
  void close() noexcept override { script_.is_open = false; }
  void reconnect() override {
    ++script_.reconnections;
    if (!script_.reconnects) {
      throw DeviceError("still lost");
    }
  }
  int slices() const noexcept override { return script_.slices; }
  std::uint32_t exchange(const double* forces, double* positions) noexcept override {
    ++script_.exchanges;
    for (int i = 0; i < script_.slices; ++i) {
      const auto slot = static_cast<std::size_t>(i);
      script_.forces[slot] = forces[i];
      positions[i] = script_.positions[slot];
    }
    return script_.flags;
  }
  void makeSafe() noexcept override { script_.is_safe = true; }
  void rearm() noexcept override { script_.is_safe = false; }
  int extraDelayTicks() const noexcept override { return script_.extra_delay_ticks; }
  bool isRaw() const noexcept override { return script_.is_raw; }
  std::uint64_t uncalibrated() const noexcept override { return script_.uncalibrated; }
  bool canHurt() const noexcept override { return script_.can_hurt; }
  bool isSteppedByExchange() const noexcept override { return script_.is_stepped_by_exchange; }
  double damping() const noexcept override { return script_.damping; }
  double declaredDamping() const noexcept override { return 0.1 * script_.damping; }
  tgr::DeviceClock* clock() noexcept override { return script_.has_clock ? this : nullptr; }
  bool move(const tgr::HandMove& move) noexcept override {
    script_.target = {move.slice, move.target_m};
    return true;
  }

 private:
  void start(tgr::TickTarget&) override {}
  void stop() noexcept override {}
  double periodS() const noexcept override { return 0.001; }

  Script& script_;
};

}  // namespace ergotic::test
