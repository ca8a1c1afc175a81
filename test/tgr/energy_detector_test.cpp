// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/energy_detector.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace ergotic::tgr {
namespace {

constexpr double kTick = 1e-3;

EnergyDetector::Rules rules() {
  return {20.0, 0.1, 0.3, 0.02, 0.0};
}

/// Ticks of a hand on a sine of 1 Hz and 20 mm until too much came out; -1: never.
template <class Force>
int ticksUntilTooMuch(EnergyDetector detector, int ticks, Force force) {
  double last = 0.0;
  double last_x = 0.0;
  for (int n = 0; n < ticks; ++n) {
    const double x = 0.02 * std::sin(2.0 * M_PI * n * kTick);
    const double v = (x - last_x) / kTick;
    if (!detector.look(force(x, v), x - last)) {
      return n;
    }
    last = last_x = x;
  }
  return -1;
}

TEST(EnergyDetectorTest, CountsTheWorkOfTheForceBeforeEachMove) {
  EnergyDetector detector(rules(), kTick);
  detector.look(2.0, 0.5);
  EXPECT_EQ(detector.energy(), 0.0) << "no force acted on the first way";
  detector.look(-3.0, -0.25);
  EXPECT_NEAR(detector.energy(), 0.5, 1e-3);
  detector.look(0.0, 0.125);
  EXPECT_NEAR(detector.energy(), 0.875, 1e-3);
}

TEST(EnergyDetectorTest, LetsPassiveModelsBeForHours) {
  const int hour = 3600 * 1000;
  const EnergyDetector detector(rules(), kTick);
  EXPECT_EQ(ticksUntilTooMuch(detector, hour, [](double x, double) { return -1000.0 * x; }), -1);
  EXPECT_EQ(ticksUntilTooMuch(detector, hour, [](double x, double) { return -1e5 * x; }), -1)
      << "a spring beyond the force limit";
  EXPECT_EQ(ticksUntilTooMuch(detector, hour, [](double, double v) { return -20.0 * v; }), -1);
}

TEST(EnergyDetectorTest, FindsAModelThatPushesTheHandAlong) {
  const EnergyDetector detector(rules(), kTick);
  const int tick = ticksUntilTooMuch(detector, 5000, [](double, double v) { return 40.0 * v; });
  // 0.3 J of the 40 N s/m (2 pi 20 mm/s)^2 / 2 = 0.316 W: after a second or so, less what is
  // forgotten meanwhile.
  EXPECT_GT(tick, 900);
  EXPECT_LT(tick, 5000);
}

TEST(EnergyDetectorTest, FindsANegativeSpringOnItsFirstWayOut) {
  EnergyDetector detector(rules(), kTick);
  double x = 0.0;
  while (detector.look(5000.0 * x, 1e-4)) {
    x += 1e-4;
    ASSERT_LT(x, 0.03);
  }
  // 5 N/mm up to 20 N, then 20 N: 0.3 J after 4 mm + 13 mm, and a little for what it forgot.
  EXPECT_GT(x, 0.017);
  EXPECT_LT(x, 0.019);
}

/// Ticks of 20 N along with the hand until too much came out.
int ticksOfPushing(EnergyDetector& detector) {
  int ticks = 0;
  while (detector.look(20.0, 1e-3)) {
    ++ticks;
  }
  return ticks;
}

TEST(EnergyDetectorTest, RemembersNoMoreThanASpringCanStore) {
  EnergyDetector detector(rules(), kTick);
  for (int n = 0; n < 100000; ++n) {
    detector.look(-20.0, 1e-3);  // takes 2 kJ
  }
  EXPECT_EQ(detector.energy(), 2.0);
  EXPECT_LT(ticksOfPushing(detector), (2.0 + 0.3) / 0.02);
}

TEST(EnergyDetectorTest, ForgetsWhatWasDissipatedLongAgo) {
  EnergyDetector detector(rules(), kTick);
  for (int n = 0; n < 1000; ++n) {
    detector.look(-20.0, 1e-3);
  }
  for (int n = 0; n < 10000; ++n) {
    detector.look(0.0, 0.0);
  }
  EXPECT_NEAR(detector.energy(), 0.02, 1e-3);
  EXPECT_NEAR(ticksOfPushing(detector), (0.02 + 0.3) / 0.02, 2);
}

TEST(EnergyDetectorTest, RemembersASpringThatIsHeldForAnHour) {
  EnergyDetector detector(rules(), kTick);
  double x = 0.0;
  const auto spring = [&] { return -500.0 * x; };
  for (; x > -0.03; x -= 1e-5) {
    detector.look(spring(), -1e-5);
  }
  const double stored = detector.energy();
  EXPECT_NEAR(stored, 0.5 * 500.0 * 0.03 * 0.03, 1e-3);
  for (int n = 0; n < 3600000; ++n) {
    detector.look(spring(), 0.0);
  }
  EXPECT_EQ(detector.energy(), stored);
}

TEST(EnergyDetectorTest, GivesASupplyWhereOneIsAllowed) {
  EnergyDetector::Rules generous = rules();
  generous.supply_w = 10.0;
  const EnergyDetector detector(generous, kTick);
  EXPECT_EQ(ticksUntilTooMuch(detector, 10000, [](double, double v) { return 40.0 * v; }), -1);
}

TEST(EnergyDetectorTest, ForgetsOnRequest) {
  EnergyDetector detector(rules(), kTick);
  detector.look(-20.0, 0.0);
  detector.look(-20.0, 0.01);
  ASSERT_GT(detector.energy(), 0.0);
  detector.forget();
  EXPECT_EQ(detector.energy(), 0.0);
  EXPECT_TRUE(detector.look(0.0, 1.0)) << "no force acted";
}

TEST(EnergyDetectorTest, StartsAgainFromWhatAnySpringCanHaveStored) {
  EnergyDetector detector(rules(), kTick);
  detector.look(20.0, 0.0);
  detector.restart();
  EXPECT_TRUE(detector.look(20.0, -0.03));
  EXPECT_NEAR(detector.energy(), 0.6, 1e-12);
  EXPECT_TRUE(detector.look(0.0, 0.03)) << "all of it, and no more";
  EXPECT_NEAR(detector.energy(), 0.0, 1e-3);
  detector.look(20.0, 0.0);
  detector.restart();
  EXPECT_TRUE(detector.look(20.0, 0.03)) << "judges nothing";
  EXPECT_EQ(detector.energy(), 0.0) << "no spring pushes away from where it is at rest";
}

}  // namespace
}  // namespace ergotic::tgr
