// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/slider_scale.hpp"

#include <cmath>
#include <limits>

#include "rviz/peak_hold.hpp"
#include "support/test.hpp"

namespace ergotic::panel {
namespace {

constexpr int kSteps = SliderScale::kSteps;

TEST(SliderScaleTest, IsLogarithmicOverMoreThanTwoDecadesAboveZero) {
  EXPECT_TRUE(SliderScale(1e-4, 1.0).isLogarithmic());
  EXPECT_FALSE(SliderScale(1e-2, 1.0).isLogarithmic());
  EXPECT_FALSE(SliderScale(0.0, 1e6).isLogarithmic());
  EXPECT_FALSE(SliderScale(-1e3, 1e6).isLogarithmic());
}

TEST(SliderScaleTest, EndsAreExactAndNothingLiesBeyondThem) {
  for (const auto& [low, high] : {std::pair{1e-5, 1e-2}, {0.1, 0.7}, {-3.0, 1.0}, {2.0, 2.0}}) {
    const SliderScale scale(low, high);
    EXPECT_EQ(scale.valueAt(0), low);
    EXPECT_EQ(scale.valueAt(kSteps), high);
    EXPECT_EQ(scale.valueAt(-5), low);
    EXPECT_EQ(scale.valueAt(kSteps + 5), high);
    for (int step = 0; step <= kSteps; ++step) {
      EXPECT_GE(scale.valueAt(step), low);
      EXPECT_LE(scale.valueAt(step), high);
    }
  }
}

TEST(SliderScaleTest, StepsComeBackFromTheirValues) {
  for (const SliderScale& scale : {SliderScale(1e-5, 1e-2), SliderScale(-3.0, 1.0)}) {
    for (int step = 0; step <= kSteps; ++step) {
      EXPECT_EQ(scale.stepAt(scale.valueAt(step)), step);
    }
  }
}

TEST(SliderScaleTest, EachLogarithmicStepIsTheSameRatio) {
  const SliderScale scale(1e-4, 1.0);
  EXPECT_NEAR(scale.valueAt(kSteps / 2), 1e-2, 1e-14);
  EXPECT_NEAR(scale.valueAt(401) / scale.valueAt(400), scale.valueAt(901) / scale.valueAt(900),
              1e-12);
}

TEST(SliderScaleTest, WhatIsOutOfRangeIsPutToAnEnd) {
  const SliderScale scale(0.2, 0.4);
  EXPECT_EQ(scale.stepAt(-1.0), 0);
  EXPECT_EQ(scale.stepAt(9.0), kSteps);
  EXPECT_EQ(scale.stepAt(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(SliderScale(2.0, 2.0).stepAt(2.0), 0);
}

TEST(ThrottleTest, LetsTheFirstThroughAtOnceAndOnce) {
  Throttle throttle(0.1);
  EXPECT_FALSE(throttle.take(0.0));
  throttle.offer(1.0);
  EXPECT_EQ(throttle.take(0.0), 1.0);
  EXPECT_FALSE(throttle.take(10.0));
}

TEST(ThrottleTest, TheNewestWinsAndIsNeverLost) {
  Throttle throttle(0.1);
  throttle.offer(1.0);
  EXPECT_EQ(throttle.take(5.0), 1.0);
  throttle.offer(2.0);
  throttle.offer(3.0);
  EXPECT_FALSE(throttle.take(5.05));
  EXPECT_EQ(throttle.take(5.11), 3.0);
}

TEST(ThrottleTest, LetsNoMoreThroughThanItMay) {
  Throttle throttle(1.0 / 30.0);
  int sent = 0;
  double last = 0.0;
  for (int ms = 0; ms < 10'000; ++ms) {  // a drag of ten seconds, a value each millisecond
    throttle.offer(ms);
    if (const auto value = throttle.take(1e-3 * ms)) {
      ++sent;
      last = *value;
    }
  }
  EXPECT_LE(sent, 301);
  EXPECT_GE(sent, 290);
  EXPECT_GE(last, 9960.0);
}

TEST(PeakHoldTest, HoldsTheLargestForASecond) {
  PeakHold hold;
  EXPECT_EQ(hold.follow({1.0, -3.0}, 0.0), (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(hold.follow({2.0, -1.0}, 0.5), (std::vector<double>{2.0, 3.0}));
  EXPECT_EQ(hold.follow({0.0, -1.0}, 1.1), (std::vector<double>{2.0, 1.0}));
  EXPECT_EQ(hold.follow({0.0, -1.0}, 1.6), (std::vector<double>{0.0, 1.0}));
}

TEST(PeakHoldTest, FollowsADeviceWithAnotherNumberOfSlices) {
  PeakHold hold;
  hold.follow({1.0, 2.0}, 0.0);
  EXPECT_EQ(hold.follow({0.5}, 0.1), std::vector<double>{1.0});
  EXPECT_EQ(hold.follow({0.5, 0.25, 4.0}, 0.2), (std::vector<double>{1.0, 0.25, 4.0}));
  EXPECT_TRUE(hold.follow({}, 0.3).empty());
}

}  // namespace
}  // namespace ergotic::panel
