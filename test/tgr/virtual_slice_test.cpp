// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_slice.hpp"

#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::idealSlice;

constexpr double kStep = 1.0 / 3000.0;
constexpr HandTarget kRest{};

VirtualSlice makeSlice(const VirtualSliceConfig& config) {
  return {config, kStep, 1};
}

double energy(const VirtualSlice& slice, const VirtualSliceConfig& config, double target) {
  const double stretch = target - slice.position();
  return 0.5 * (config.mass + config.hand_mass) * slice.velocity() * slice.velocity() +
         0.5 * config.hand_stiffness * stretch * stretch;
}

TEST(VirtualSliceTest, AnswersAStepOfTheHandAsTheDampedOscillator) {
  const VirtualSliceConfig config = idealSlice();
  VirtualSlice slice = makeSlice(config);
  const double target = 0.02;
  const double mass = config.mass + config.hand_mass;
  const double decay = (config.damping + config.hand_damping) / (2.0 * mass);
  const double omega = std::sqrt(config.hand_stiffness / mass - decay * decay);
  for (int n = 1; n <= 1500; ++n) {
    slice.step(0.0, {target, 0.0});
    const double t = n * kStep;
    const double expected =
        target *
        (1.0 - std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t)));
    ASSERT_NEAR(slice.position(), expected, 1e-6 * target) << "t = " << t;
  }
}

TEST(VirtualSliceTest, SlidesAtTheSpeedThatFrictionAllows) {
  VirtualSliceConfig config = idealSlice();
  config.hand_stiffness = 0.0;
  config.hand_damping = 0.0;
  config.dry_friction = 0.5;
  VirtualSlice slice = makeSlice(config);
  for (int n = 0; n < 6000; ++n) {  // 2 s, ten time constants
    slice.step(0.6, kRest);
  }
  EXPECT_NEAR(slice.velocity(), (0.6 - 0.5) / config.damping, 1e-5);
}

TEST(VirtualSliceTest, KeepsItsEnergyWithoutFriction) {
  VirtualSliceConfig config = idealSlice();
  config.damping = 0.0;
  config.hand_damping = 0.0;
  VirtualSlice slice = makeSlice(config);
  const double start = energy(slice, config, 0.05);
  for (int n = 0; n < 30000; ++n) {
    slice.step(0.0, {0.05, 0.0});
    ASSERT_NEAR(energy(slice, config, 0.05), start, 1e-10 * start);
  }
}

TEST(VirtualSliceTest, NeverGainsEnergyWithoutADrive) {
  for (const double dry : {0.0, 0.02, 0.3, 5.0}) {
    for (const double stop : {0.1, 0.03}) {
      VirtualSliceConfig config = idealSlice();
      config.dry_friction = dry;
      config.stop = stop;
      VirtualSlice slice = makeSlice(config);
      for (int n = 0; n < 60; ++n) {  // swing it first
        slice.step(n < 30 ? 80.0 : -80.0, kRest);
      }
      double before = energy(slice, config, 0.0);
      for (int n = 0; n < 6000; ++n) {
        slice.step(0.0, kRest);
        const double now = energy(slice, config, 0.0);
        ASSERT_LE(now, before * (1.0 + 1e-14)) << "dry " << dry << ", stop " << stop;
        before = now;
      }
    }
  }
}

TEST(VirtualSliceTest, SticksBelowDryFrictionAndSlipsAboveIt) {
  VirtualSliceConfig config = idealSlice();
  config.dry_friction = 0.1;
  VirtualSlice slice = makeSlice(config);
  for (int n = 0; n < 3000; ++n) {
    slice.step(n % 2 == 0 ? 0.0999 : -0.0999, kRest);
    ASSERT_EQ(slice.position(), 0.0);
    ASSERT_EQ(slice.velocity(), 0.0);
  }
  slice.step(0.1001, kRest);
  EXPECT_GT(slice.position(), 0.0);
}

TEST(VirtualSliceTest, ComesToAFullStopWhereFrictionHolds) {
  VirtualSliceConfig config = idealSlice();
  config.dry_friction = 0.3;
  VirtualSlice slice = makeSlice(config);
  for (int n = 0; n < 6000; ++n) {
    slice.step(0.0, {0.02, 0.0});
  }
  EXPECT_EQ(slice.velocity(), 0.0);
  EXPECT_LE(config.hand_stiffness * std::abs(0.02 - slice.position()), config.dry_friction);
  const double resting = slice.position();
  slice.step(0.0, {0.02, 0.0});
  EXPECT_EQ(slice.position(), resting);
}

TEST(VirtualSliceTest, StopsDeadAtItsEndsAndLeavesWhenPulled) {
  VirtualSliceConfig config = idealSlice();
  config.stop = 0.01;
  VirtualSlice slice = makeSlice(config);
  for (const double side : {1.0, -1.0}) {
    for (int n = 0; n < 3000; ++n) {
      slice.step(side * 100.0, kRest);
      ASSERT_LE(std::abs(slice.position()), config.stop);
    }
    EXPECT_EQ(slice.position(), side * config.stop);
    EXPECT_EQ(slice.velocity(), 0.0);
    slice.step(0.0, kRest);
    EXPECT_LT(std::abs(slice.position()), config.stop);
  }
}

TEST(VirtualSliceTest, SaturatesTheActuatorBeforeItLags) {
  for (const double bandwidth : {300.0, std::numeric_limits<double>::infinity()}) {
    VirtualSliceConfig config = idealSlice();
    config.force_limit = 20.0;
    config.bandwidth = bandwidth;
    VirtualSlice asked = makeSlice(config);
    VirtualSlice able = makeSlice(config);
    for (int n = 0; n < 20; ++n) {
      asked.step(-1e9, kRest);
      able.step(-20.0, kRest);
      ASSERT_EQ(asked.position(), able.position());
    }
    EXPECT_LT(able.position(), 0.0);
  }
}

TEST(VirtualSliceTest, FeelsNoForceThatIsNotANumber) {
  VirtualSlice slice = makeSlice(idealSlice());
  slice.step(std::numeric_limits<double>::quiet_NaN(), kRest);
  EXPECT_EQ(slice.position(), 0.0);
}

TEST(VirtualSliceTest, ReadsInWholeQuanta) {
  VirtualSliceConfig config = idealSlice();
  config.quantum = 1e-4;
  VirtualSlice slice = makeSlice(config);
  for (int n = 0; n < 300; ++n) {
    slice.step(5.0, kRest);
    const double read = slice.read();
    ASSERT_EQ(read, config.quantum * std::round(read / config.quantum));
    ASSERT_LE(std::abs(read - slice.position()), 0.5 * config.quantum * (1.0 + 1e-9));
  }
}

TEST(VirtualSliceTest, AddsNoiseOfTheGivenMoments) {
  VirtualSliceConfig config = idealSlice();
  config.noise_rms = 0.5e-6;
  VirtualSlice slice = makeSlice(config);
  const int count = 200000;
  double sum = 0.0;
  double squares = 0.0;
  double neighbours = 0.0;
  double previous = 0.0;
  for (int n = 0; n < count; ++n) {
    const double noise = slice.read() / config.noise_rms;
    ASSERT_LE(std::abs(noise), 2.0 * std::sqrt(3.0) + 1e-12);
    sum += noise;
    squares += noise * noise;
    neighbours += noise * previous;
    previous = noise;
  }
  EXPECT_NEAR(sum / count, 0.0, 5.0 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 1.0, 5.0 * std::sqrt(1.7 / count));  // 4th moment is 2.7
  EXPECT_NEAR(neighbours / count, 0.0, 5.0 / std::sqrt(count));
}

TEST(VirtualSliceTest, AddsTheVarianceOfItsQuantaToTheNoise) {
  VirtualSliceConfig config = idealSlice();
  config.quantum = 1e-6;
  config.noise_rms = 1e-6;  // as large as the quantum: rounding is then nearly independent
  VirtualSlice slice = makeSlice(config);
  const int count = 200000;
  double squares = 0.0;
  for (int n = 0; n < count; ++n) {
    const double read = slice.read() / config.noise_rms;
    squares += read * read;
  }
  EXPECT_NEAR(squares / count, 1.0 + 1.0 / 12.0, 0.02);
}

TEST(VirtualSliceTest, RefusesSettingsOutsideTheirRange) {
  const auto refuses = [](auto change) {
    VirtualSliceConfig config;
    change(config);
    EXPECT_THROW(makeSlice(config), Exception);
  };
  refuses([](VirtualSliceConfig& c) { c.mass = 0.0; });
  refuses([](VirtualSliceConfig& c) { c.damping = -1.0; });
  refuses([](VirtualSliceConfig& c) { c.force_limit = 201.0; });
  refuses([](VirtualSliceConfig& c) { c.hand_stiffness = std::nan(""); });
  refuses([](VirtualSliceConfig& c) { c.bandwidth = 9.0; });
  refuses([](VirtualSliceConfig& c) { c.bandwidth = std::nan(""); });
  refuses([](VirtualSliceConfig& c) { c.delay = 0.0051; });
  refuses([](VirtualSliceConfig& c) { c.delay = -1e-9; });
  refuses([](VirtualSliceConfig& c) { c.volts = SliceCalibration{}; });
  EXPECT_THROW(VirtualSlice(VirtualSliceConfig{}, 0.0, 1), Exception);
}

constexpr double kTwoPi = 6.283185307179586;

/// Its velocity is the impulse of its actuator.
VirtualSliceConfig freeMass() {
  VirtualSliceConfig config = idealSlice();
  config.mass = 0.5;
  config.hand_mass = 0.0;
  config.hand_stiffness = 0.0;
  config.hand_damping = 0.0;
  config.damping = 0.0;
  return config;
}

/// Impulse of a lag that was asked for 1 N since `t`: the integral of 1 - exp(-t / tau).
double impulse(double t, double tau) {
  return t > 0.0 ? t - tau * (1.0 - std::exp(-t / tau)) : 0.0;
}

/// Takes force on and off after its very delay and as a first-order filter, whatever the tick rate.
TEST(ActuatorTest, DelaysAndLags) {
  constexpr int kPushed = 5;
  for (const double bandwidth : {50.0, 1500.0, 1e6, std::numeric_limits<double>::infinity()}) {
    for (const double delay : {0.0, 1e-5, 4e-4, 1e-3, 2.5e-3, 5e-3}) {
      for (const double step : {1e-3, 1.0 / 3150.0, 1.0 / 44100.0}) {
        VirtualSliceConfig config = freeMass();
        config.bandwidth = bandwidth;
        config.delay = delay;
        VirtualSlice slice(config, step, 1);
        const double tau = 1.0 / (kTwoPi * bandwidth);
        for (int n = 1; n <= 20; ++n) {
          slice.step(n <= kPushed ? 2.0 : 0.0, kRest);
          const double t = n * step - delay;
          const double pushed = impulse(t, tau) - impulse(t - kPushed * step, tau);
          ASSERT_NEAR(slice.velocity(), 2.0 / config.mass * pushed, 1e-14)
              << bandwidth << " Hz, delay " << delay << " s, step " << step << " s, n " << n;
        }
      }
    }
  }
}

/// It lags by the drag of its own damping.
TEST(ActuatorTest, FollowsAMovingHandThroughTheDelayedPartOfAStep) {
  for (const double delay : {0.0, 3.3e-4}) {  // the latter cuts every step in two
    VirtualSliceConfig config = idealSlice();
    config.delay = delay;
    VirtualSlice slice(config, 1e-3, 1);
    const double speed = 0.01;
    for (int n = 0; n < 3000; ++n) {
      slice.step(0.0, {speed * n * 1e-3, speed});
    }
    const double lag = config.damping * speed / config.hand_stiffness;
    EXPECT_NEAR(slice.position(), speed * 3.0 - lag, 1e-9);
  }
}

}  // namespace
}  // namespace ergotic::tgr
