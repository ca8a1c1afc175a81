// SPDX-License-Identifier: BSD-3-Clause
// The strokes of a hand that is under way, drawn by what draws them in the tick.
#include "ergotic/tgr/players/hand_ways.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/tgr/driver.hpp"
#include "support/test.hpp"
#include "tgr/drivers/virtual/player_hands.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kStepS = 1e-4;

/// A hand at slice 3 that takes strokes at once, and stands where it is told.
class HandWaysTest : public ::testing::Test {
 protected:
  HandWaysTest() { hands_.clear(); }

  void take(const Strokes& strokes) {
    for (const Stroke& stroke : strokes) {
      HandMove move;
      move.slice = stroke.index;
      move.target_m = stroke.target_m;
      move.glide_s = stroke.glide_s;
      move.delay_s = stroke.after_s;
      move.lets_go = stroke.lets_go;
      ASSERT_TRUE(move.isValid(12));
      hands_.take(move, now_s_);
    }
  }
  void follow(double target_m, double speed) {
    Strokes strokes;
    ways_.follow(kHand, target_m, 0.0, speed, now_s_, strokes);
    take(strokes);
  }
  void glide(double target_m, double glide_s, double after_s = 0.0) {
    Strokes strokes;
    ways_.glide(kHand, target_m, 0.0, glide_s, after_s, now_s_, strokes);
    take(strokes);
  }
  /// \return the greatest speed meanwhile, m/s
  double run(double seconds) {
    double fastest = 0.0;
    const auto steps = static_cast<int>(std::lround(seconds / kStepS));
    for (int i = 0; i < steps; ++i) {
      const double begin_m = place_m_;
      const auto holding = hands_.step(kHand.second, {place_m_, 0.0}, now_s_, kStepS);
      now_s_ += kStepS;
      place_m_ = holding.target.position + kStepS * holding.target.velocity;
      fastest = std::max(fastest, std::abs(place_m_ - begin_m) / kStepS);
    }
    return fastest;
  }

  const HandWays::Hand kHand{"", 3};
  HandWays ways_;
  PlayerHands hands_;
  double now_s_ = 0.0;
  double place_m_ = 0.0;
};

TEST_F(HandWaysTest, AHandFollowsWithinTwentyMilliseconds) {
  follow(0.002, 1.0);
  EXPECT_NEAR(run(0.02), 0.1, 1e-6) << "evenly";
  EXPECT_NEAR(place_m_, 0.002, 1e-9);
}

TEST_F(HandWaysTest, AHandFollowsNoFasterThanItMay) {
  follow(0.02, 0.1);
  EXPECT_NEAR(run(0.1), 0.1, 1e-6);
  EXPECT_NEAR(place_m_, 0.01, 1e-6);
  follow(0.0, 0.1);  // back, from where it is
  EXPECT_NEAR(run(0.05), 0.1, 1e-5);
  EXPECT_NEAR(place_m_, 0.005, 2e-5);
  run(0.06);
  EXPECT_NEAR(place_m_, 0.0, 1e-9);
}

TEST_F(HandWaysTest, StepsOfAWheelBecomeAnEvenMotion) {
  constexpr double kPeriodS = 0.01;
  constexpr double kWidthM = 0.02 / 127.0;
  for (int i = 1; i <= 40; ++i) {
    follow(i * kWidthM, 1.0);
    const double fastest = run(kPeriodS);
    if (i > 20) {
      EXPECT_NEAR(fastest, kWidthM / kPeriodS, 1e-4) << i;
    }
  }
  EXPECT_NEAR(place_m_, 39 * kWidthM, 1e-6) << "one period behind: two steps of it are to come";
}

TEST_F(HandWaysTest, AGlideGoesToItsEndBeforeAHandFollows) {
  glide(0.02, 0.1);
  run(0.03);
  for (int i = 1; i <= 7; ++i) {  // a finger that presses more while its key still goes down
    follow(0.02 + 0.0005 * i, 1.0);
    run(0.01);
  }
  EXPECT_NEAR(place_m_, 0.02, 1e-5);
  run(0.02);
  EXPECT_NEAR(place_m_, 0.0235, 1e-9);
}

TEST_F(HandWaysTest, AHandThatFollowsAfterAGlideDoesNotJump) {
  glide(0.01, 0.05);
  run(1.0);
  follow(0.012, 0.2);
  EXPECT_NEAR(run(0.02), 0.1, 1e-3);
  EXPECT_NEAR(place_m_, 0.012, 1e-9);
}

TEST_F(HandWaysTest, AGlideBeginsWithinALine) {
  follow(0.02, 0.1);
  run(0.1);
  glide(0.0, 0.1);
  EXPECT_NEAR(run(0.1), 1.875 * 0.01 / 0.1, 1e-3);
  EXPECT_NEAR(place_m_, 0.0, 1e-9);
}

TEST_F(HandWaysTest, WhatIsThereAlreadyIsToldNothing) {
  follow(0.002, 1.0);
  run(0.1);
  Strokes strokes;
  ways_.follow(kHand, 0.002, 0.0, 1.0, now_s_, strokes);
  EXPECT_TRUE(strokes.empty());
}

TEST_F(HandWaysTest, LetsGoOfWhatItHolds) {
  Strokes strokes;
  ways_.letGo(kHand, strokes);
  EXPECT_TRUE(strokes.empty());
  follow(0.002, 1.0);
  ways_.letGo(kHand, strokes);
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_TRUE(strokes[0].lets_go);
  EXPECT_EQ(ways_.toldOf(kHand, 0.5), 0.5);
}

}  // namespace
}  // namespace ergotic::tgr
