// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/in_process_driver.hpp"

#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"

namespace ergotic::tgr {
namespace {

VirtualDriverConfig idealConfig() {
  VirtualDriverConfig config;
  config.slices = 1;
  config.slice = test::idealSlice();
  return config;
}

/// The largest |x| in each half of `ticks` ticks against a spring of `stiffness` to rest, after a
/// push of one tick.
std::array<double, 2> swing(Driver& driver, double stiffness, int ticks) {
  std::array<double, 2> largest{};
  double force = 0.01;
  for (int n = 0; n < ticks; ++n) {
    double x = 0.0;
    driver.exchange(&force, &x);
    force = -stiffness * x;
    double& half = largest[2 * n < ticks ? 0 : 1];
    half = std::max(half, std::abs(x));
  }
  return largest;
}

/// Stable up to K = 2 b / ((1 + 2 d) T) with d ticks of delay (Colgate & Schenkel 1997,
/// generalised), with the damping b of slice and hand.
TEST(InProcessDriverTest, IsStableUpToTheLimitOfOneTickOfDelayAndTheExtraOnes) {
  const double rate = 1000.0;
  for (const int extra : {0, 1, 3}) {
    VirtualDriverConfig config = idealConfig();
    config.extra_delay_ticks = extra;
    config.slice.hand_damping = 5.0;
    config.slice.hand_stiffness = 0.0;  // its share of the stiffness has no delay
    const double damping = config.slice.damping + config.slice.hand_damping;
    const double limit = 2.0 * damping * rate / (1.0 + 2.0 * (1 + extra));
    InProcessDriver driver(config);
    EXPECT_EQ(driver.extraDelayTicks(), extra);
    driver.open(rate);
    const auto below = swing(driver, 0.97 * limit, 20000);
    EXPECT_LT(below[1], below[0]) << "extra delay " << extra;
    driver.open(rate);
    const auto above = swing(driver, 1.03 * limit, 20000);
    EXPECT_GT(above[1], above[0]) << "extra delay " << extra;
  }
}

TEST(InProcessDriverTest, DelaysForcesByOneTickAndTheExtraOnes) {
  for (const int extra : {0, 1, 5, kMaxExtraDelayTicks}) {
    VirtualDriverConfig config = idealConfig();
    config.extra_delay_ticks = extra;
    InProcessDriver driver(config);
    driver.open(1000.0);
    int moved_at = -1;
    for (int n = 0; n < 40 && moved_at < 0; ++n) {
      const double force = n == 0 ? 5.0 : 0.0;
      double x = 0.0;
      driver.exchange(&force, &x);
      moved_at = x != 0.0 ? n : -1;
    }
    EXPECT_EQ(moved_at, 1 + extra);
  }
}

TEST(InProcessDriverTest, HoldsTheForceOverTheWholeTick) {
  VirtualDriverConfig config = idealConfig();
  config.slice.hand_stiffness = 0.0;
  config.slice.hand_damping = 0.0;
  config.slice.damping = 0.0;
  InProcessDriver driver(config);
  const double rate = 1000.0;
  driver.open(rate);
  const std::array<double, 3> forces{4.0, 0.0, 0.0};
  std::array<double, 3> x{};
  for (std::size_t n = 0; n < forces.size(); ++n) {
    driver.exchange(&forces[n], &x[n]);
  }
  const double mass = config.slice.mass + config.slice.hand_mass;
  const double dv = 4.0 / mass / rate;
  EXPECT_EQ(x[0], 0.0);
  EXPECT_NEAR(x[1], 0.5 * dv / rate, 1e-15);
  EXPECT_NEAR(x[2], 1.5 * dv / rate, 1e-15);
}

/// The second one if it is opened `times` = 2.
std::vector<double> performance(std::uint64_t seed, int times = 1) {
  const test::ScratchFile gesture("0,0,0\n0.1,0,0.02\n0.2,1,0.01\n0.3,1,-0.02\n");
  VirtualDriverConfig config;
  config.slices = 2;
  config.gesture_file = gesture.path();
  config.seed = seed;
  InProcessDriver driver(config);
  std::vector<double> positions;
  for (int time = 0; time < times; ++time) {
    driver.open(3150.0);
    positions.clear();
    std::array<double, 2> forces{};
    std::array<double, 2> x{};
    for (int n = 0; n < 2000; ++n) {
      driver.exchange(forces.data(), x.data());
      forces = {-300.0 * x[0], -50.0 * x[1]};
      positions.insert(positions.end(), x.begin(), x.end());
    }
    driver.close();
  }
  return positions;
}

TEST(InProcessDriverTest, GivesTheSameBitsForTheSameSeed) {
  EXPECT_EQ(performance(7), performance(7));
  EXPECT_NE(performance(7), performance(8));
  EXPECT_EQ(performance(7), performance(7, 2)) << "it begins anew when opened again";
}

TEST(InProcessDriverTest, GivesEverySliceANoiseOfItsOwn) {
  VirtualDriverConfig config;
  config.slices = 2;
  config.slice.quantum = 0.0;
  config.slice.noise_rms = 1.0e-3;
  InProcessDriver driver(config);
  driver.open(1000.0);
  const std::array<double, 2> forces{};
  double product = 0.0;
  const int count = 20000;
  for (int n = 0; n < count; ++n) {
    std::array<double, 2> x{};
    driver.exchange(forces.data(), x.data());
    product += x[0] * x[1] / (config.slice.noise_rms * config.slice.noise_rms);
  }
  EXPECT_NEAR(product / count, 0.0, 5.0 / std::sqrt(count));
}

TEST(InProcessDriverTest, FollowsTheGestureFileAtTheTickRate) {
  const test::ScratchFile gesture("0,0,0\n1,0,0.05\n");
  VirtualDriverConfig config = idealConfig();
  config.gesture_file = gesture.path();
  const double speed = 0.05;
  const double lag = config.slice.damping * speed / config.slice.hand_stiffness;
  for (const double rate : {500.0, 3150.0, 44100.0}) {
    InProcessDriver driver(config);
    driver.open(rate);
    const double force = 0.0;
    double x = 0.0;
    const int ticks = static_cast<int>(0.9 * rate);
    for (int n = 0; n < ticks; ++n) {
      driver.exchange(&force, &x);
    }
    EXPECT_NEAR(x, speed * ticks / rate - lag, 2e-6) << "at " << rate << " Hz";
  }
}

TEST(InProcessDriverTest, PrefersATargetThatWasSetToTheGesture) {
  const test::ScratchFile gesture("0,0,0.02\n0,1,0.02\n");
  VirtualDriverConfig config = idealConfig();
  config.slices = 2;
  config.gesture_file = gesture.path();
  InProcessDriver driver(config);
  driver.open(1000.0);
  EXPECT_TRUE(driver.setTarget(1, 0.01));
  EXPECT_TRUE(driver.setTarget(1, -0.01));
  const std::array<double, 2> forces{};
  std::array<double, 2> x{};
  for (int n = 0; n < 5000; ++n) {
    driver.exchange(forces.data(), x.data());
  }
  EXPECT_NEAR(x[0], 0.02, 1e-9);
  EXPECT_NEAR(x[1], -0.01, 1e-9);
}

TEST(InProcessDriverTest, RefusesTargetsThatAreNotReachable) {
  InProcessDriver driver(idealConfig());
  EXPECT_TRUE(driver.setTarget(0, 0.1));
  EXPECT_FALSE(driver.setTarget(0, 0.1001));
  EXPECT_FALSE(driver.setTarget(0, std::nan("")));
  EXPECT_FALSE(driver.setTarget(1, 0.0));
  EXPECT_FALSE(driver.setTarget(-1, 0.0));
}

TEST(InProcessDriverTest, AnswersFalseWhenTooManyTargetsWait) {
  InProcessDriver driver(idealConfig());
  driver.open(1000.0);
  int taken = 0;
  while (taken < 100000 && driver.setTarget(0, 0.01)) {
    ++taken;
  }
  EXPECT_GE(taken, 64);
  EXPECT_LT(taken, 100000);
  const double force = 0.0;
  double x = 0.0;
  driver.exchange(&force, &x);
  EXPECT_TRUE(driver.setTarget(0, 0.01)) << "an exchange takes what waits";
}

TEST(InProcessDriverTest, DropsForcesUnderWayWhenMadeSafe) {
  VirtualDriverConfig config = idealConfig();
  config.extra_delay_ticks = 4;
  InProcessDriver driver(config);
  driver.open(1000.0);
  const double force = 15.0;
  double x = 0.0;
  for (int n = 0; n < 5; ++n) {
    driver.exchange(&force, &x);
  }
  ASSERT_EQ(x, 0.0);  // the first force would act in the next tick
  driver.makeSafe();
  for (int n = 0; n < 20; ++n) {
    driver.exchange(&force, &x);
    ASSERT_EQ(x, 0.0);
  }
}

TEST(InProcessDriverTest, DeclaresTheDelayOfItsActuatorsAndItsLeastDamping) {
  VirtualDriverConfig config = idealConfig();
  config.slices = 3;
  config.extra_delay_ticks = 2;
  config.slice.delay = 0.0012;
  config.others[2] = config.slice;
  config.others[2].delay = 0.0031;
  config.others[2].damping = 0.4;
  InProcessDriver driver(config);
  EXPECT_EQ(driver.damping(), 0.4);
  EXPECT_EQ(driver.declaredDamping(), 0.4);
  EXPECT_FALSE(driver.isRaw());
  driver.open(1000.0);
  EXPECT_EQ(driver.extraDelayTicks(), 2 + 4);
  driver.open(3000.0);
  EXPECT_EQ(driver.extraDelayTicks(), 2 + 10);
}

TEST(InProcessDriverTest, LetsEachSliceBeAsItIs) {
  VirtualDriverConfig config = idealConfig();
  config.slices = 2;
  config.others[1] = config.slice;
  config.others[1].hand_stiffness = 4.0 * config.slice.hand_stiffness;
  InProcessDriver driver(config);
  driver.open(1000.0);
  const std::array<double, 2> forces{10.0, 10.0};
  std::array<double, 2> x{};
  for (int n = 0; n < 9000; ++n) {
    driver.exchange(forces.data(), x.data());
  }
  EXPECT_NEAR(x[0], 10.0 / config.slice.hand_stiffness, 1e-12);
  EXPECT_NEAR(x[1], 2.5 / config.slice.hand_stiffness, 1e-12);
}

TEST(InProcessDriverTest, TakesRecordedPositionsForTargetsAtTheirOwnRateOrItsOwn) {
  std::string text = "tick,x0\n";
  for (int tick = 0; tick < 1000; ++tick) {
    text += std::to_string(tick + 77) + "," + std::to_string(2e-5 * tick) + "\n";
  }
  const test::ScratchFile file(text);
  VirtualDriverConfig config = idealConfig();
  config.gesture_file = file.path();
  const double force = 0.0;
  double x = 0.0;
  for (const double gesture_rate : {0.0, 500.0}) {
    config.gesture_rate = gesture_rate;
    InProcessDriver driver(config);
    driver.open(2000.0);
    const int ticks = 900;
    for (int n = 0; n < ticks; ++n) {
      driver.exchange(&force, &x);
    }
    const double speed = 2e-5 * (gesture_rate > 0.0 ? gesture_rate : 2000.0);
    const double lag = config.slice.damping * speed / config.slice.hand_stiffness;
    EXPECT_NEAR(x, speed * ticks / 2000.0 - lag, 1e-4);
  }
}

TEST(InProcessDriverTest, RefusesSettingsOutsideTheirRange) {
  const auto refuses = [](auto change) {
    VirtualDriverConfig config;
    change(config);
    EXPECT_THROW(makeVirtualDriver(config), Exception);
  };
  refuses([](VirtualDriverConfig& c) { c.slices = 0; });
  refuses([](VirtualDriverConfig& c) { c.slices = kMaxSlices + 1; });
  refuses([](VirtualDriverConfig& c) { c.extra_delay_ticks = -1; });
  refuses([](VirtualDriverConfig& c) { c.extra_delay_ticks = 17; });
  refuses([](VirtualDriverConfig& c) { c.slice.mass = -0.3; });
  refuses([](VirtualDriverConfig& c) { c.others[12] = c.slice; });
  refuses([](VirtualDriverConfig& c) { c.others[3].mass = -0.3; });
  refuses([](VirtualDriverConfig& c) { c.gesture_file = "/nowhere/g.csv"; });
}

TEST(InProcessDriverTest, TellsHowLongItsGestureHasBeenPlayedAndWhatThatAsksOfTheScene) {
  const test::ScratchFile file("0,0,0.01\n0.002,$tension,80\n");
  VirtualDriverConfig config = idealConfig();
  config.gesture_file = file.path();
  const auto driver = makeFaultyDriver(makeVirtualDriver(config));
  ASSERT_EQ(driver->gestureValues().size(), 1U);
  EXPECT_EQ(driver->gestureValues().front().parameter, "tension");
  for (int session = 0; session < 2; ++session) {
    driver->open(1000.0);
    for (int n = 0; n < 3; ++n) {
      EXPECT_DOUBLE_EQ(driver->gestureTime(), 1e-3 * n);
      const double force = 0.0;
      double x = 0.0;
      driver->exchange(&force, &x);
    }
    driver->close();
  }
}

TEST(InProcessDriverTest, IsSteppedByExchangesWhateverStandsBeforeIt) {
  EXPECT_TRUE(InProcessDriver(idealConfig()).isSteppedByExchange());
  EXPECT_TRUE(test::FaultyRig().driver().isSteppedByExchange());
  EXPECT_TRUE(test::CalibratedRig().driver().isSteppedByExchange());
  EXPECT_TRUE(test::CombinedRig().driver().isSteppedByExchange());
}

}  // namespace
}  // namespace ergotic::tgr
