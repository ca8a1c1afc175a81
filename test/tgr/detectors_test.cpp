// SPDX-License-Identifier: BSD-3-Clause
#include "constants.hpp"
#include "ergotic/tgr/safety/blow_up_detector.hpp"
#include "ergotic/tgr/safety/energy_detector.hpp"
#include "support/test.hpp"
#include "tgr/sensor_noise.hpp"

namespace ergotic::tgr {
namespace {

using test::kNan;

constexpr double kTick = 1e-3;

EnergyDetector::Rules energyRules() {
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
  EnergyDetector detector(energyRules(), kTick);
  detector.look(2.0, 0.5);
  EXPECT_EQ(detector.energy(), 0.0) << "no force acted on the first way";
  detector.look(-3.0, -0.25);
  EXPECT_NEAR(detector.energy(), 0.5, 1e-3);
  detector.look(0.0, 0.125);
  EXPECT_NEAR(detector.energy(), 0.875, 1e-3);
}

TEST(EnergyDetectorTest, LetsPassiveModelsBeForHours) {
  const int hour = 3600 * 1000;
  const EnergyDetector detector(energyRules(), kTick);
  EXPECT_EQ(ticksUntilTooMuch(detector, hour, [](double x, double) { return -1000.0 * x; }), -1);
  EXPECT_EQ(ticksUntilTooMuch(detector, hour, [](double x, double) { return -1e5 * x; }), -1)
      << "a spring beyond the force limit";
  EXPECT_EQ(ticksUntilTooMuch(detector, hour, [](double, double v) { return -20.0 * v; }), -1);
}

TEST(EnergyDetectorTest, FindsAModelThatPushesTheHandAlong) {
  const EnergyDetector detector(energyRules(), kTick);
  const int tick = ticksUntilTooMuch(detector, 5000, [](double, double v) { return 40.0 * v; });
  // 0.3 J of the 40 N s/m (2 pi 20 mm/s)^2 / 2 = 0.316 W: after a second or so, less what is
  // forgotten meanwhile.
  EXPECT_GT(tick, 900);
  EXPECT_LT(tick, 5000);
}

TEST(EnergyDetectorTest, FindsANegativeSpringOnItsFirstWayOut) {
  EnergyDetector detector(energyRules(), kTick);
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
  EnergyDetector detector(energyRules(), kTick);
  for (int n = 0; n < 100000; ++n) {
    detector.look(-20.0, 1e-3);  // takes 2 kJ
  }
  EXPECT_EQ(detector.energy(), 2.0);
  EXPECT_LT(ticksOfPushing(detector), (2.0 + 0.3) / 0.02);
}

TEST(EnergyDetectorTest, ForgetsWhatWasDissipatedLongAgo) {
  EnergyDetector detector(energyRules(), kTick);
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
  EnergyDetector detector(energyRules(), kTick);
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
  EnergyDetector::Rules generous = energyRules();
  generous.supply_w = 10.0;
  const EnergyDetector detector(generous, kTick);
  EXPECT_EQ(ticksUntilTooMuch(detector, 10000, [](double, double v) { return 40.0 * v; }), -1);
}

TEST(EnergyDetectorTest, ForgetsOnRequest) {
  EnergyDetector detector(energyRules(), kTick);
  detector.look(-20.0, 0.0);
  detector.look(-20.0, 0.01);
  ASSERT_GT(detector.energy(), 0.0);
  detector.forget();
  EXPECT_EQ(detector.energy(), 0.0);
  EXPECT_TRUE(detector.look(0.0, 1.0)) << "no force acted";
}

TEST(EnergyDetectorTest, StartsAgainFromWhatAnySpringCanHaveStored) {
  EnergyDetector detector(energyRules(), kTick);
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

constexpr double kLimit = 20.0;
constexpr double kRawLimit = 5000.0;

/// How often a sequence F(0), F(1)... was beyond the limit before it was told to be mad.
struct Found {
  FaultReason reason = FaultReason::kNone;
  int beyond = 0;
};

template <class Force>
Found look(BlowUpDetector& detector, int ticks, Force force) {
  Found found;
  for (int n = 0; n < ticks; ++n) {
    const double f = force(n);
    found.reason = detector.look(f);
    if (found.reason != FaultReason::kNone) {
      break;
    }
    found.beyond += std::abs(f) > kLimit ? 1 : 0;
  }
  return found;
}

class BlowUpDetectorTest : public ::testing::Test {
 protected:
  BlowUpDetector detector_{kLimit, kRawLimit};
};

/// `base` and then what grows from 1 N by a factor.
Found grow(BlowUpDetector& detector, double base, double factor) {
  detector.forget();
  detector.look(base);
  return look(detector, 40, [&](int n) { return base + std::pow(factor, n); });
}

TEST_F(BlowUpDetectorTest, FindsADoublingForceBeforeItsSecondSampleBeyondTheLimit) {
  for (const double base : {0.0, 15.0, -15.0, -3.3}) {
    for (const double factor : {2.0, -2.0, 3.0, -3.0}) {
      const Found found = grow(detector_, base, factor);
      EXPECT_EQ(found.reason, FaultReason::kModelBlowUp);
      EXPECT_LE(found.beyond, 1) << base << " N, x " << factor;
    }
  }
}

TEST_F(BlowUpDetectorTest, FindsAnyGrowthWithinFiveTicksWhereverItBegan) {
  for (double base = -20.0; base <= 20.0; base += 0.1) {
    for (const double factor : {1.9, 2.0, -2.0, 5.0, 10.0, 100.0, -100.0}) {
      const Found found = grow(detector_, base, factor);
      EXPECT_NE(found.reason, FaultReason::kNone);
      EXPECT_LE(found.beyond, 4) << base << " N, x " << factor;
    }
  }
}

TEST_F(BlowUpDetectorTest, FindsAnOscillationThatGrowsHoweverSlowly) {
  const Found found = look(detector_, 1000, [](int n) { return 0.1 * std::pow(-1.05, n); });
  EXPECT_EQ(found.reason, FaultReason::kModelBlowUp);
  EXPECT_LE(found.beyond, 1);
}

TEST(SmallForceLimitTest, LetsGrowthBelowFourNewtonsBe) {
  for (const double limit : {0.5, 2.0}) {
    const auto found = [limit](double newtons) {
      BlowUpDetector detector(limit, kRawLimit);
      return look(detector, 20, [=](int n) { return n % 2 == 0 ? newtons : -newtons; }).reason;
    };
    EXPECT_EQ(found(3.9), FaultReason::kNone) << limit;
    EXPECT_EQ(found(4.1), FaultReason::kModelBlowUp) << limit;
  }
}

TEST_F(BlowUpDetectorTest, FindsWhatIsNotFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    detector_.look(1.0);
    EXPECT_EQ(detector_.look(bad), FaultReason::kModelBlowUp);
    EXPECT_EQ(detector_.look(1.0), FaultReason::kNone) << "it looks on";
  }
}

TEST_F(BlowUpDetectorTest, FindsAForceBeyondAllReasonHoweverSlowlyItCame) {
  const Found found = look(detector_, 100000, [](int n) { return -0.1 * n; });
  EXPECT_EQ(found.reason, FaultReason::kForceTooHigh);
  EXPECT_NEAR(found.beyond, 10 * (kRawLimit - kLimit), 1);
}

TEST_F(BlowUpDetectorTest, LetsHardContactsBe) {
  // F = k x^p, touched anywhere within a tick; up to what fills the range of 30 mm at 5 N/mm.
  for (const double exponent : {1.0, 1.5, 2.0}) {
    for (const double first : {0.0, 0.001, 0.1, 0.3, 0.5, 0.9, 1.0}) {
      for (const double unit : {0.1, 1.0, 5.0, 20.0, 100.0}) {
        detector_.forget();
        detector_.look(0.0);
        const Found found =
            look(detector_, 12, [&](int n) { return unit * std::pow(first + n, exponent); });
        const bool in_range = unit * std::pow(first + 11, exponent) <= kRawLimit;
        EXPECT_EQ(found.reason, in_range ? FaultReason::kNone : FaultReason::kForceTooHigh)
            << unit << " N (" << first << " + n)^" << exponent;
      }
    }
  }
}

TEST_F(BlowUpDetectorTest, LetsAFeltHammerBeUpToThreeTimesTheLimit) {
  for (double first = 0.0; first < 1.0; first += 0.01) {
    detector_.forget();
    detector_.look(0.0);
    const double unit = 3.0 * kLimit / std::pow(3.0 + first, 2.5);
    const Found found = look(detector_, 5, [&](int n) { return unit * std::pow(first + n, 2.5); });
    EXPECT_EQ(found.reason, FaultReason::kNone) << first;
  }
}

TEST_F(BlowUpDetectorTest, LetsNoiseOfLessThanAQuarterOfTheLimitBe) {
  SensorNoise noise(3);
  const Found found = look(detector_, 1000000, [&](int) { return 30.0 + 0.7 * noise.next(); });
  EXPECT_EQ(found.reason, FaultReason::kNone);
}

TEST_F(BlowUpDetectorTest, LetsAReleaseAndANewModelBe) {
  detector_.look(150.0);
  EXPECT_EQ(detector_.look(0.0), FaultReason::kNone);
  EXPECT_EQ(detector_.look(-150.0), FaultReason::kNone);
  detector_.forget();
  EXPECT_EQ(detector_.look(150.0), FaultReason::kNone) << "after forgetting anything may come";
}

TEST_F(BlowUpDetectorTest, WorksUnderAnyLimit) {
  for (const double limit : {0.0, 1.0, 200.0}) {
    BlowUpDetector detector(limit, kRawLimit);
    EXPECT_EQ(look(detector, 40, [](int n) { return std::ldexp(1.0, n); }).reason,
              FaultReason::kModelBlowUp);
  }
}

}  // namespace
}  // namespace ergotic::tgr
