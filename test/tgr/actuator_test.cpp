// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "tgr/drivers/virtual/virtual_slice.hpp"

/// The actuator of a virtual slice, seen by a mass that moves freely: its velocity is the impulse.
namespace ergotic::tgr {
namespace {

constexpr HandTarget kRest{};
constexpr double kTwoPi = 6.283185307179586;

VirtualSliceConfig freeMass() {
  VirtualSliceConfig config;
  config.mass = 0.5;
  config.hand_mass = 0.0;
  config.hand_stiffness = 0.0;
  config.hand_damping = 0.0;
  config.damping = 0.0;
  config.dry_friction = 0.0;
  config.stop = 0.1;
  config.bandwidth = std::numeric_limits<double>::infinity();
  return config;
}

/// Impulse of a lag that was asked for 1 N since `t`: the integral of 1 - exp(-t / tau).
double impulse(double t, double tau) {
  return t > 0.0 ? t - tau * (1.0 - std::exp(-t / tau)) : 0.0;
}

TEST(ActuatorTest, LagsAsAFirstOrderFilterWhateverTheTickRate) {
  for (const double bandwidth : {50.0, 1500.0, 15000.0, 1e6}) {
    for (const double step : {1e-3, 1.0 / 3150.0, 1.0 / 44100.0}) {
      VirtualSliceConfig config = freeMass();
      config.bandwidth = bandwidth;
      VirtualSlice slice(config, step, 1);
      const double tau = 1.0 / (kTwoPi * bandwidth);
      for (int n = 1; n <= 8; ++n) {
        slice.step(2.0, kRest);
        ASSERT_NEAR(slice.velocity(), 2.0 / config.mass * impulse(n * step, tau), 1e-14)
            << bandwidth << " Hz, step " << step << " s, n " << n;
      }
    }
  }
}

TEST(ActuatorTest, TakesTheForceOffAsItTakesItOn) {
  VirtualSliceConfig config = freeMass();
  config.bandwidth = 300.0;
  const double step = 1e-3;
  const double tau = 1.0 / (kTwoPi * config.bandwidth);
  VirtualSlice slice(config, step, 1);
  for (int n = 1; n <= 20; ++n) {
    slice.step(n <= 5 ? 1.0 : 0.0, kRest);
    const double expected = impulse(n * step, tau) - impulse((n - 5) * step, tau);
    ASSERT_NEAR(slice.velocity(), expected / config.mass, 1e-14);
  }
}

TEST(ActuatorTest, PassesHalfThePowerAtItsBandwidth) {
  // |H|^2 = 1 / (1 + (f / bandwidth)^2)
  const double bandwidth = 100.0;
  const double step = 1e-4;
  for (const double ratio : {0.1, 1.0, 3.0}) {
    VirtualSliceConfig config = freeMass();
    config.bandwidth = bandwidth;
    config.mass = 100.0;  // so that the slice stays away from its stops
    VirtualSlice slice(config, step, 1);
    const double omega = kTwoPi * bandwidth * ratio;
    double last = 0.0;
    double sine = 0.0;
    double cosine = 0.0;
    const int settle = 2000;
    const int count = 30000;
    for (int n = 0; n < settle + count; ++n) {
      slice.step(std::sin(omega * (n + 0.5) * step), kRest);
      const double force = config.mass * (slice.velocity() - last) / step;
      last = slice.velocity();
      if (n >= settle) {
        sine += 2.0 / count * force * std::sin(omega * (n + 0.5) * step);
        cosine += 2.0 / count * force * std::cos(omega * (n + 0.5) * step);
      }
    }
    EXPECT_NEAR(sine * sine + cosine * cosine, 1.0 / (1.0 + ratio * ratio), 0.01) << ratio;
  }
}

TEST(ActuatorTest, DelaysByTheVeryTime) {
  const double step = 1e-3;
  for (const double delay : {1e-5, 4e-4, 1e-3, 2.5e-3, 3e-3, 5e-3}) {
    VirtualSliceConfig config = freeMass();
    config.delay = delay;
    VirtualSlice slice(config, step, 1);
    for (int n = 1; n <= 12; ++n) {
      slice.step(n <= 4 ? 3.0 : 0.0, kRest);
      const double pushed = std::min(std::max(n * step - delay, 0.0), 4.0 * step);
      ASSERT_NEAR(slice.velocity(), 3.0 / config.mass * pushed, 1e-14)
          << "delay " << delay << ", n " << n;
    }
  }
}

TEST(ActuatorTest, DelaysAndLags) {
  VirtualSliceConfig config = freeMass();
  config.delay = 1.3e-3;
  config.bandwidth = 200.0;
  const double step = 5e-4;
  VirtualSlice slice(config, step, 1);
  for (int n = 1; n <= 30; ++n) {
    slice.step(1.0, kRest);
    const double expected = impulse(n * step - config.delay, 1.0 / (kTwoPi * config.bandwidth));
    ASSERT_NEAR(slice.velocity(), expected / config.mass, 1e-14);
  }
}

TEST(ActuatorTest, SaturatesBeforeItLags) {
  VirtualSliceConfig config = freeMass();
  config.bandwidth = 300.0;
  config.force_limit = 20.0;
  VirtualSlice asked(config, 1e-3, 1);
  VirtualSlice able(config, 1e-3, 1);
  for (int n = 0; n < 5; ++n) {
    asked.step(-1e9, kRest);
    able.step(-20.0, kRest);
    ASSERT_EQ(asked.velocity(), able.velocity());
  }
  EXPECT_LT(able.velocity(), 0.0);
}

TEST(ActuatorTest, FollowsAMovingHandThroughTheDelayedPartOfAStep) {
  VirtualSliceConfig config;
  config.dry_friction = 0.0;
  config.stop = 0.1;
  config.delay = 3.3e-4;  // cuts every step in two
  VirtualSlice slice(config, 1e-3, 1);
  const double speed = 0.01;
  for (int n = 0; n < 3000; ++n) {
    slice.step(0.0, {speed * n * 1e-3, speed});
  }
  EXPECT_NEAR(slice.position(), speed * 3.0 - config.damping * speed / config.hand_stiffness, 1e-9);
}

TEST(ActuatorTest, RefusesSettingsOutsideTheirRange) {
  const auto refuses = [](auto change) {
    VirtualSliceConfig config;
    change(config);
    EXPECT_THROW(VirtualSlice(config, 1e-3, 1), Exception);
  };
  refuses([](VirtualSliceConfig& c) { c.bandwidth = 9.0; });
  refuses([](VirtualSliceConfig& c) { c.bandwidth = std::nan(""); });
  refuses([](VirtualSliceConfig& c) { c.delay = 0.0051; });
  refuses([](VirtualSliceConfig& c) { c.delay = -1e-9; });
  refuses([](VirtualSliceConfig& c) { c.volts = SliceCalibration{}; });
}

}  // namespace
}  // namespace ergotic::tgr
