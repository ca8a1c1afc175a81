// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/blow_up_detector.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tgr/sensor_noise.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kLimit = 20.0;
constexpr double kRawLimit = 5000.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

TEST_F(BlowUpDetectorTest, FindsADoublingForceBeforeItsSecondSampleBeyondTheLimit) {
  for (const double base : {0.0, 15.0, -15.0, -3.3}) {
    for (const double factor : {2.0, -2.0, 3.0, -3.0}) {
      detector_.forget();
      detector_.look(base);
      const Found found = look(detector_, 40, [&](int n) { return base + std::pow(factor, n); });
      EXPECT_EQ(found.reason, FaultReason::kModelBlowUp);
      EXPECT_LE(found.beyond, 1) << base << " N, x " << factor;
    }
  }
}

TEST_F(BlowUpDetectorTest, FindsAnyGrowthWithinFiveTicksWhereverItBegan) {
  for (double base = -20.0; base <= 20.0; base += 0.1) {
    for (const double factor : {1.9, 2.0, -2.0, 5.0, 10.0, 100.0, -100.0}) {
      detector_.forget();
      detector_.look(base);
      const Found found = look(detector_, 40, [&](int n) { return base + std::pow(factor, n); });
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
