// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/tgr/safety_chain.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/test.hpp"

/// A virtual hand that pushes a virtual slice into a virtual wall, through the safety chain: one
/// tick of delay, as in a station.
namespace ergotic::test {

/// The device and the hand of docs/safety.md: 0.3 + 0.1 kg, 2 + 5 N s/m, 500 N/m, nothing else.
inline tgr::VirtualDriverConfig plainDevice() {
  tgr::VirtualDriverConfig config;
  config.slices = 1;
  config.slice.dry_friction = 0.0;
  config.slice.noise_rms = 0.0;
  config.slice.quantum = 0.0;
  config.slice.hand_damping = 5.0;
  return config;
}

/// 2 b / ((1 + 2 d) T) of that device and hand, d = 1: above it the wall oscillates.
inline double stiffnessLimit(double rate_hz) {
  return 2.0 * (2.0 + 5.0) * rate_hz / 3.0;
}

/// A chain that lets everything pass that it can be told to let pass.
inline tgr::SafetyConfig openChain() {
  tgr::SafetyConfig config;
  config.ramp_s = 0.1;
  config.force_limit_n = tgr::kAbsoluteForceLimitN;
  config.raw_force_limit_n = 1e6;
  config.slew_n_per_s = 1e6;
  config.max_speed_m_per_s = 100.0;
  config.energy_limit_j = 100.0;
  config.energy_cap_j = 10.0;
  config.energy_supply_w = 20.0;  // enough of it: the clamp never acts
  return config;
}

class WallLoop {
 public:
  WallLoop(const tgr::VirtualDriverConfig& device, const tgr::SafetyConfig& safety, double rate_hz)
      : rate_hz_(rate_hz),
        driver_(tgr::makeVirtualDriver(device)),
        chain_(safety, 1, 1.0 / rate_hz, device.extra_delay_ticks) {
    driver_->open(rate_hz);
  }

  void engage() { chain_.engage(); }
  void disengage() { chain_.disengage(); }
  void recover() { chain_.recover(); }
  /// A stall or a swap: zero goes out in place of the last force, and for `muted` ticks more.
  void resume(int muted) {
    chain_.resume();
    force_ = 0.0;
    for (int n = 0; n < muted; ++n) {
      sense();
    }
  }
  void aimAt(double target_m) { driver_->setTarget(0, target_m); }

  /// Runs for `seconds` with raw force `force(x, v)`, N, x in m, v the backward difference, m/s.
  template <class Force>
  void run(double seconds, Force force) {
    const auto ticks = static_cast<std::int64_t>(std::llround(seconds * rate_hz_));
    for (std::int64_t n = 0; n < ticks; ++n) {
      tick(force);
    }
  }

  template <class Force>
  void tick(Force force) {
    sense();
    force_ = force(x_, velocity_);
    chain_.limit(&force_);
  }

  /// As `run`; \return largest speed met, m/s
  template <class Force>
  double peakSpeed(double seconds, Force force) {
    double peak = 0.0;
    const auto ticks = static_cast<std::int64_t>(std::llround(seconds * rate_hz_));
    for (std::int64_t n = 0; n < ticks; ++n) {
      tick(force);
      peak = std::max(peak, std::abs(velocity_));
    }
    return peak;
  }

  /// Energy is measured at the device, from here on.
  void startMeter() { energy_ = least_energy_ = 0.0; }
  double leastEnergy() const { return least_energy_; }  ///< J, < 0: given out
  double position() const { return x_; }
  double velocity() const { return velocity_; }
  double force() const { return force_; }
  const tgr::SafetyChain& chain() const { return chain_; }

 private:
  void sense() {
    double x = x_;
    const std::uint32_t flags = driver_->exchange(&force_, &x);
    energy_ -= acting_ * (x - x_);
    least_energy_ = std::min(least_energy_, energy_);
    acting_ = force_;
    chain_.validate(&x, flags, 0);
    velocity_ = (x - x_) * rate_hz_;
    x_ = x;
  }

  double rate_hz_;
  std::unique_ptr<tgr::Driver> driver_;
  tgr::SafetyChain chain_;
  double x_ = 0.0;
  double velocity_ = 0.0;
  double force_ = 0.0;
  double acting_ = 0.0;  // since the last exchange
  double energy_ = 0.0;
  double least_energy_ = 0.0;
};

/// A wall below `at`: it pushes back what is deeper.
struct Wall {
  double stiffness = 0.0;  ///< N/m
  double damping = 0.0;    ///< N s/m, inside the wall
  double at = 0.0;         ///< m
  double operator()(double x, double v) const {
    return x < at ? std::max(-stiffness * (x - at) - damping * v, 0.0) : 0.0;
  }
};

}  // namespace ergotic::test
