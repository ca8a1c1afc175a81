// SPDX-License-Identifier: BSD-3-Clause
#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"

/// Virtual devices that speak volts, and their calibration from one end to the other.

namespace ergotic::tgr {
namespace {

constexpr double kVoltsRateHz = 1000.0;

SliceCalibration truth(double metres_per_volt) {
  SliceCalibration c;
  c.is_calibrated = true;
  c.metres_per_volt = metres_per_volt;
  c.rest_volts = 0.7;
  c.volts_per_newton = -0.05;
  c.zero_volts = 0.002;
  c.max_volts = 5.0;
  return c;
}

VirtualDriverConfig rawConfig() {
  VirtualDriverConfig config;
  config.slices = 2;
  config.slice.volts = truth(0.005);
  config.others[1] = config.slice;
  config.others[1].volts = truth(-0.004);
  return config;
}

struct Exchange {
  std::array<double, 2> forces{};
  std::array<double, 2> positions{};
};

void run(Driver& driver, Exchange& exchange, int ticks) {
  for (int n = 0; n < ticks; ++n) {
    driver.exchange(exchange.forces.data(), exchange.positions.data());
  }
}

TEST(VirtualVoltsTest, GivesAndTakesVolts) {
  VirtualDriverConfig config = rawConfig();
  config.slice = test::plainSlice();
  config.slice.volts = truth(0.005);
  config.others.clear();
  const auto driver = makeVirtualDriver(config);
  EXPECT_TRUE(driver->isRaw());
  driver->open(kVoltsRateHz);
  Exchange e;
  e.forces = {0.002, 0.002 - 0.05 * 5.0};  // 0 N, 5 N
  run(*driver, e, 1);
  EXPECT_DOUBLE_EQ(e.positions[0], 0.7);
  run(*driver, e, 3000);
  EXPECT_DOUBLE_EQ(e.positions[0], 0.7);
  const double stretch = 5.0 / config.slice.hand_stiffness;
  EXPECT_NEAR(e.positions[1], 0.7 + stretch / 0.005, 1e-9);
  e.forces = {-1000.0, std::nan("")};  // the output ends at -5 V: 100.04 N
  run(*driver, e, 1);
  const double still = e.positions[0];
  run(*driver, e, 3000);
  EXPECT_DOUBLE_EQ(e.positions[0], 0.7 + config.slice.stop / 0.005) << "at its stop";
  EXPECT_LT(still, e.positions[0]);
}

TEST(VirtualVoltsTest, StaysAtTheRailOfItsSensor) {
  VirtualDriverConfig config = rawConfig();
  config.slice.volts->high_volts = 2.0;
  const auto driver = makeVirtualDriver(config);
  driver->open(kVoltsRateHz);
  ASSERT_TRUE(driver->setTarget(0, 0.02));
  Exchange e;
  run(*driver, e, 3000);
  EXPECT_EQ(e.positions[0], 2.0);
}

TEST(VirtualVoltsTest, RefusesADeviceOfWhichOnlySomeSlicesSpeakVolts) {
  VirtualDriverConfig config = rawConfig();
  config.others[1].volts.reset();
  EXPECT_THROW(makeVirtualDriver(config), Exception);
}

/// Holds each slice at three places, looks at the sensors, fits, and plays.
TEST(VirtualVoltsTest, IsCalibratedFromOneEndToTheOther) {
  const VirtualDriverConfig config = rawConfig();
  Calibration unknown;
  unknown.slices.resize(2);
  for (SliceCalibration& slice : unknown.slices) {
    slice.volts_per_newton = -0.05;
    slice.zero_volts = 0.002;
    slice.max_volts = 5.0;
  }
  const auto driver = makeCalibratedDriver(makeVirtualDriver(config), unknown);
  driver->open(kVoltsRateHz);
  EXPECT_EQ(driver->uncalibrated(), 3U);
  std::array<std::vector<CalibrationPoint>, 2> points;
  Exchange e;
  for (const double place : {-0.02, 0.005, 0.02}) {
    driver->setTarget(0, place);
    driver->setTarget(1, place);
    run(*driver, e, 3000);
    std::array<double, 2> sum{};
    std::array<double, 2> squares{};
    const int samples = 500;
    for (int n = 0; n < samples; ++n) {
      run(*driver, e, 1);
      std::array<double, 2> volts{};
      driver->readVolts(volts.data());
      for (std::size_t i = 0; i < 2; ++i) {
        sum[i] += volts[i];
        squares[i] += volts[i] * volts[i];
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const double mean = sum[i] / samples;
      const double variance = std::max(squares[i] / samples - mean * mean, 0.0);
      points[i].push_back({place, mean, std::sqrt(variance)});
    }
  }
  // A hand that is held by dry friction stands up to friction / stiffness beside its target.
  const double off = config.slice.dry_friction / config.slice.hand_stiffness;
  for (int i = 0; i < 2; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    const SliceCalibration found = fit(points[slot], driver->calibration().slices[slot], 2.0 * off);
    const double gain = i == 0 ? 0.005 : -0.004;
    EXPECT_NEAR(found.metres_per_volt, gain, std::abs(gain) * off / 0.015);
    EXPECT_NEAR(found.rest_volts, 0.7, off / std::abs(gain));
    EXPECT_LT(found.noise_m, 2e-6);
    driver->set(i, found);
  }
  driver->setTarget(0, 0.01);
  driver->setTarget(1, 0.01);
  e.forces = {2.0, 2.0};
  run(*driver, e, 5000);
  EXPECT_EQ(driver->uncalibrated(), 0U);
  const double expected = 0.01 + 2.0 / config.slice.hand_stiffness;
  EXPECT_NEAR(e.positions[0], expected, 3.0 * off);
  EXPECT_NEAR(e.positions[1], expected, 3.0 * off);
}

}  // namespace
}  // namespace ergotic::tgr
