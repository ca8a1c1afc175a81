// SPDX-License-Identifier: BSD-3-Clause
// The hands that players move: when targets are due, how they are reached, and with what force.
#include "tgr/drivers/virtual/player_hands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/realtime_scope.hpp"
#include "tgr/drivers/virtual/in_process_driver.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kTick = 1.0 / 3150.0;

HandMove moveTo(double target_m, double time_s, HandGrip grip = HandGrip::kFirm) {
  HandMove move;
  move.target_m = target_m;
  move.time_s = time_s;
  move.grip = grip;
  return move;
}

HandMove letGo() {
  HandMove move;
  move.lets_go = true;
  return move;
}

/// A slice without friction, noise or steps of its sensor.
VirtualDriverConfig idealConfig() {
  VirtualDriverConfig config;
  config.slices = 1;
  config.slice.dry_friction = 0.0;
  config.slice.noise_rms = 0.0;
  config.slice.quantum = 0.0;
  return config;
}

/// A driver whose ticks a test counts.
class PlayedSlice {
 public:
  explicit PlayedSlice(const VirtualDriverConfig& config = idealConfig()) : driver_(config) {
    driver_.open(1.0 / kTick);
  }
  double tick(double force = 0.0) {
    driver_.exchange(&force, &x_);
    ++ticks_;
    return x_;
  }
  void run(double seconds, double force = 0.0) {
    for (const double end = now() + seconds; now() < end;) {
      tick(force);
    }
  }
  void move(const HandMove& move) {
    const bool is_taken = driver_.move(move);
    EXPECT_TRUE(is_taken);
  }
  double now() const { return static_cast<double>(ticks_) * kTick; }
  double x() const { return x_; }

 private:
  InProcessDriver driver_;
  double x_ = 0.0;
  int ticks_ = 0;
};

TEST(MoveTimingTest, KeepsDistancesInTimeWhateverTheClockOfTheSource) {
  for (const double source_clock : {0.0, 1.7e9, -50.0}) {
    MoveTiming timing;
    double last_due = 0.0;
    for (int n = 0; n < 200; ++n) {
      const double stamp = 0.008 * n;
      const double due = timing.dueAt(stamp + source_clock, stamp + 0.001);
      if (n > 1) {
        EXPECT_NEAR(due - last_due, 0.008, 1e-6) << n;
        EXPECT_NEAR(due, stamp + 0.001 + 0.008 + 0.0005, 1e-6) << "one interval late";
      }
      last_due = due;
    }
  }
}

TEST(MoveTimingTest, TakesOutTheJitterOfTheWay) {
  MoveTiming timing;
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> jitter(0.0, 0.006);
  double last_due = 0.0;
  for (int n = 0; n < 1000; ++n) {
    const double stamp = 0.008 * n;
    const double due = timing.dueAt(stamp, stamp + 0.002 + jitter(dice));
    if (n > 100) {  // an early one has been seen; since then the clocks may drift by 1e-3
      EXPECT_NEAR(due - last_due, 0.008, 0.002) << n;
    }
    last_due = due;
  }
}

/// A message may name all slices of a device: that is one arrival.
TEST(MoveTimingTest, ManySlicesOfAMessageCountOnce) {
  MoveTiming of_one;
  MoveTiming of_twelve;
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> jitter(0.0, 0.006);
  for (int n = 0; n < 1000; ++n) {
    const double stamp = 0.008 * n;
    const double now = stamp + jitter(dice);
    const double due = of_one.dueAt(stamp, now);
    for (int slice = 0; slice < 12; ++slice) {
      EXPECT_EQ(of_twelve.dueAt(stamp, now), due);
    }
  }
}

TEST(MoveTimingTest, WaitsNoLongerThanTwelveMilliseconds) {
  MoveTiming timing;
  for (int n = 0; n < 50; ++n) {
    const double now = 0.05 * n;
    EXPECT_LE(timing.dueAt(now, now) - now, MoveTiming::kMaxDelayS + 1e-12);
  }
}

TEST(MoveTimingTest, AClockThatIsSetBackALittleIsForgottenSoon) {
  MoveTiming timing;
  double last_due = 0.0;
  for (int n = 0; n < 400; ++n) {
    const double now = 0.008 * n;
    const double due = timing.dueAt(n < 200 ? now : now - 0.05, now);
    if (n > 250) {
      EXPECT_NEAR(due - last_due, 0.008, 1e-6);
      EXPECT_NEAR(due - now, 0.0085, 1e-6);
    }
    last_due = due;
  }
}

TEST(MoveTimingTest, BeginsAnewWhenAClockJumps) {
  MoveTiming timing;
  for (int n = 0; n < 20; ++n) {
    timing.dueAt(100.0 + 0.008 * n, 0.008 * n);
  }
  EXPECT_NEAR(timing.dueAt(5000.0, 0.168), 0.168, 1e-9);
  EXPECT_NEAR(timing.dueAt(5000.008, 0.176), 0.176 + 0.0085, 1e-6);
}

/// An even motion of 125 Hz gives straight lines: the target's speed has no ripple.
TEST(PlayerHandsTest, AnEvenSweepHasNoStaircase) {
  PlayerHands hands;
  constexpr double kSpeed = 0.1;
  double next_event = 0.0;
  for (int n = 0; n * kTick < 0.6; ++n) {
    const double now = n * kTick;
    if (now >= next_event) {
      hands.take(moveTo(kSpeed * next_event, next_event), now);
      next_event += 0.008;
    }
    const auto holding = hands.step(0, {}, now, kTick);
    if (now > 0.1) {
      EXPECT_NEAR(holding.target.velocity, kSpeed, 0.05 * kSpeed) << now;
    }
  }
}

TEST(PlayerHandsTest, AHandTakesHoldWhereTheSliceIs) {
  PlayerHands hands;
  hands.take(moveTo(0.05, 10.0), 0.0);
  const auto first = hands.step(0, {-0.02}, 0.0, kTick);
  EXPECT_DOUBLE_EQ(first.target.position, -0.02);
  EXPECT_LE(std::abs(first.target.velocity), PlayerHands::kMaxSpeed * (1 + 1e-12));
}

TEST(PlayerHandsTest, ATargetIsNeverFasterThanTwoMetresPerSecond) {
  PlayerHands hands;
  std::mt19937 dice(3);
  std::uniform_real_distribution<double> place(-kMaxTargetM, kMaxTargetM);
  double last = 0.0;
  for (int n = 0; n < 20000; ++n) {
    const double now = n * kTick;
    if (n % 7 == 0) {
      hands.take(moveTo(place(dice), now), now);
    }
    const auto holding = hands.step(0, {}, now, kTick);
    if (n > 0) {
      EXPECT_LE(std::abs(holding.target.position - last),
                PlayerHands::kMaxSpeed * kTick * (1 + 1e-9));
    }
    last = holding.target.position;
  }
}

TEST(PlayerHandsTest, MoreMovesThanItCanKeepEndAtTheNewest) {
  PlayerHands hands;
  hands.take(moveTo(0.0, 0.0), 0.0);
  hands.step(0, {}, 0.0, kTick);
  for (int n = 1; n <= 1000; ++n) {
    hands.take(moveTo(1e-5 * n, 1e-5 * n), kTick);
  }
  double last = 0.0;
  for (int n = 1; n < 400; ++n) {
    const auto holding = hands.step(0, {}, n * kTick, kTick);
    last = holding.target.position + holding.target.velocity * kTick;
  }
  EXPECT_DOUBLE_EQ(last, 0.01);
}

TEST(PlayerHandsTest, RefusesWhatIsOutsideItsRange) {
  InProcessDriver driver(idealConfig());
  const auto takes = [&](void (*change)(HandMove&)) {
    HandMove move = moveTo(0.01, 1.0);
    change(move);
    return driver.move(move);
  };
  EXPECT_TRUE(takes([](HandMove&) {}));
  EXPECT_FALSE(takes([](HandMove& move) { move.slice = 1; }));
  EXPECT_FALSE(takes([](HandMove& move) { move.slice = -1; }));
  EXPECT_FALSE(takes([](HandMove& move) { move.target_m = 0.1001; }));
  EXPECT_FALSE(takes([](HandMove& move) { move.target_m = std::nan(""); }));
  EXPECT_FALSE(takes([](HandMove& move) { move.time_s = HUGE_VAL; }));
  EXPECT_FALSE(takes([](HandMove& move) { move.timeout_s = std::nan(""); }));
  EXPECT_FALSE(takes([](HandMove& move) { move.glide_s = -0.1; }));
  EXPECT_FALSE(takes([](HandMove& move) { move.delay_s = std::nan(""); }));
  EXPECT_FALSE(takes([](HandMove& move) { move.source = kMaxHandSources; }));
}

TEST(PlayedSliceTest, AHandPutsTheSliceWhereItWants) {
  for (const HandGrip grip : {HandGrip::kSoft, HandGrip::kFirm, HandGrip::kQuick}) {
    PlayedSlice slice;
    slice.move(moveTo(0.02, 0.0, grip));
    slice.run(1.0);
    EXPECT_NEAR(slice.x(), 0.02, 1e-6);
  }
}

/// x = target - F / k.
TEST(PlayedSliceTest, TheModelsForceHoldsTheHandBackByItsStiffness) {
  PlayedSlice slice;
  slice.move(moveTo(0.02, 0.0, HandGrip::kSoft));
  slice.run(2.0, -4.0);
  EXPECT_NEAR(slice.x(), 0.02 - 4.0 / 500.0, 1e-6);
}

/// A force just below the most that the grip gives is held; one just above pulls the slice away to
/// its stop, whatever the target.
TEST(PlayedSliceTest, TheHandGivesNoMoreThanItsGripAllows) {
  PlayedSlice held;
  held.move(moveTo(0.0, 0.0, HandGrip::kFirm));
  held.run(2.0, 9.9);
  EXPECT_NEAR(held.x(), 9.9 / 1500.0, 1e-6);

  PlayedSlice lost;
  lost.move(moveTo(-0.1, 0.0, HandGrip::kFirm));
  lost.run(2.0, 10.1);
  EXPECT_NEAR(lost.x(), VirtualSliceConfig().stop, 1e-9);
}

/// What the hand gives, told by the motion of the slice: F_hand = M a + b v.
TEST(PlayedSliceTest, TheForceStaysWithinItsLimitOverAHundredThousandRandomTargets) {
  VirtualDriverConfig config = idealConfig();
  config.slice.stop = 0.1;
  PlayedSlice slice(config);
  std::mt19937 dice(11);
  std::uniform_real_distribution<double> place(-0.05, 0.05);
  const double mass = config.slice.mass + config.slice.hand_mass;
  std::array<double, 3> x{};
  double most = 0.0;
  for (int n = 0; n < 100'000; ++n) {
    slice.move(moveTo(place(dice), slice.now(), HandGrip::kFirm));
    std::rotate(x.begin(), x.begin() + 1, x.end());
    x[2] = slice.tick();
    if (n > 2) {
      const double acceleration = (x[2] - 2.0 * x[1] + x[0]) / (kTick * kTick);
      const double velocity = (x[2] - x[0]) / (2.0 * kTick);
      most = std::max(most, std::abs(mass * acceleration + config.slice.damping * velocity));
    }
  }
  EXPECT_LE(most, 10.0 * 1.02) << "differences of positions tell it to 2 %";
  EXPECT_GE(most, 9.0) << "the limit is met";
}

/// On a glide the slice follows the path of minimum jerk: half the way at half the time, and the
/// greatest speed 1.875 times the mean one.
TEST(PlayedSliceTest, AGlideThrowsTheSliceAtTheSpeedThatItsLengthSays) {
  for (const double speed : {0.02, 0.1, 0.5, 1.0}) {
    constexpr double kWay = 0.02;
    const double length = 1.875 * kWay / speed;
    PlayedSlice slice;
    slice.move(moveTo(0.0, 0.0, HandGrip::kKey));
    slice.run(0.1);
    HandMove press = moveTo(kWay, slice.now(), HandGrip::kKey);
    press.glide_s = length;
    slice.move(press);
    double fastest = 0.0;
    double last = slice.x();
    for (const double end = slice.now() + length; slice.now() < end;) {
      const double x = slice.tick();
      fastest = std::max(fastest, (x - last) / kTick);
      last = x;
    }
    EXPECT_NEAR(fastest, speed, 0.01 * speed);
    slice.run(0.1);
    EXPECT_NEAR(slice.x(), kWay, 1e-5);
  }
}

/// Whatever the tick at which a move arrives, it begins as long after as it says, to a tick.
TEST(PlayedSliceTest, AMoveOnArrivalWaitsAsLongAsItSays) {
  PlayedSlice slice;
  slice.move(moveTo(0.0, 0.0, HandGrip::kKey));
  slice.run(0.2);
  HandMove press = moveTo(0.02, HandMove::kOnArrival, HandGrip::kKey);
  press.delay_s = 0.0073;
  press.glide_s = 0.05;
  const double begin = slice.now();
  slice.move(press);
  double half = 0.0;
  while (slice.now() < begin + 0.1) {
    if (slice.tick() >= 0.01 && half == 0.0) {
      half = slice.now();
    }
  }
  EXPECT_NEAR(half - begin, 0.0073 + 0.025, 2.0 * kTick);
}

TEST(PlayedSliceTest, AGlideThatWouldBeTooFastTakesItsTime) {
  for (const double glide : {1e-200, 1e-6, 0.005}) {
    PlayedSlice slice;
    HandMove press = moveTo(0.02, 0.0, HandGrip::kKey);
    press.glide_s = glide;
    slice.move(press);
    double last = 0.0;
    for (int n = 0; n < 1000; ++n) {
      const double x = slice.tick();
      EXPECT_LE(std::abs(x - last), PlayerHands::kMaxSpeed * kTick * 1.05);
      last = x;
    }
    EXPECT_NEAR(slice.x(), 0.02, 1e-4);
  }
}

TEST(PlayedSliceTest, AHandThatLetsGoBeforeItHasPulledDoesNotPull) {
  PlayedSlice slice;
  slice.run(0.5, 5.0);  // held by the gesture's hand against a force
  const double before = slice.x();
  slice.move(moveTo(-0.05, slice.now(), HandGrip::kKey));
  slice.move(letGo());
  slice.tick(0.0);
  slice.tick(0.0);
  EXPECT_NEAR(slice.x(), before, 1e-4);
  slice.run(0.02);
  EXPECT_NEAR(slice.x(), before, 1e-3);
}

TEST(PlayedSliceTest, ARepeatedGlideBeginsWhereTheKeyWasLeft) {
  PlayedSlice slice;
  HandMove press = moveTo(0.02, 0.0, HandGrip::kKey);
  press.glide_s = 0.1;
  slice.move(press);
  slice.run(0.05);
  const double half = slice.x();
  EXPECT_NEAR(half, 0.01, 0.0005);
  HandMove back = moveTo(0.0, slice.now(), HandGrip::kKey);
  back.glide_s = 0.1;
  slice.move(back);
  double last = half;
  for (int n = 0; n < 400; ++n) {
    const double x = slice.tick();
    EXPECT_LT(std::abs(x - last), 1.875 * 0.02 / 0.1 * kTick * 1.2) << "no jump";
    last = x;
  }
  EXPECT_NEAR(slice.x(), 0.0, 1e-4);
}

TEST(PlayedSliceTest, LettingGoLeavesTheSliceWhereItComesToRest) {
  PlayedSlice slice;
  slice.move(moveTo(0.02, 0.0));
  slice.run(1.0);
  slice.move(letGo());
  slice.run(0.05);
  const double before = slice.x();
  EXPECT_NEAR(before, 0.02, 1e-6) << "nothing pulls it home";
  slice.run(0.5, 0.5);
  EXPECT_GT(slice.x(), before + 0.005) << "nothing holds it";
}

/// Free motion with friction b: the speed falls as exp(-b t / M).
TEST(PlayedSliceTest, LettingGoInMotionKeepsTheSpeed) {
  VirtualDriverConfig config = idealConfig();
  config.slice.stop = 0.1;
  PlayedSlice slice(config);
  for (int n = 0; n < 60; ++n) {  // 0.2 m/s
    slice.move(moveTo(-0.05 + 0.2 * slice.now(), slice.now(), HandGrip::kQuick));
    slice.run(0.008);
  }
  slice.move(letGo());
  slice.run(PlayerHands::kFadeS + 2 * kTick);
  const double begin = slice.x();
  const double from = slice.tick();
  const double speed = (from - begin) / kTick;
  EXPECT_GT(speed, 0.1);
  const double rate = config.slice.damping / (config.slice.mass + config.slice.hand_mass);
  slice.run(0.1);
  EXPECT_NEAR(slice.x() - from, speed / rate * (1.0 - std::exp(-rate * 0.1)), 2e-4);
}

TEST(PlayedSliceTest, AHandThatHearsNothingLetsGo) {
  PlayedSlice slice;
  HandMove move = moveTo(0.02, 0.0);
  move.timeout_s = 0.3;
  slice.move(move);
  slice.run(0.29, 0.5);
  const double held = slice.x();
  EXPECT_LT(held, 0.021);
  slice.run(0.5, 0.5);
  EXPECT_GT(slice.x(), 0.025);
}

TEST(PlayedSliceTest, TwoSourcesHoldTwoSlices) {
  VirtualDriverConfig config = idealConfig();
  config.slices = 2;
  InProcessDriver driver(config);
  driver.open(1.0 / kTick);
  HandMove left = moveTo(0.01, 5000.0);
  HandMove right = moveTo(-0.01, 3.0);
  right.slice = 1;
  right.source = 1;
  ASSERT_TRUE(driver.move(left));
  ASSERT_TRUE(driver.move(right));
  const std::array<double, 2> forces{};
  std::array<double, 2> x{};
  for (int n = 0; n < 3150; ++n) {
    driver.exchange(forces.data(), x.data());
  }
  EXPECT_NEAR(x[0], 0.01, 1e-6);
  EXPECT_NEAR(x[1], -0.01, 1e-6);
}

TEST(PlayedSliceTest, MovingHandsIsRealtime) {
  PlayedSlice slice;
  test::expectRealtime([&] {
    for (int n = 0; n < 1000; ++n) {
      slice.move(n % 100 == 99 ? letGo() : moveTo(1e-4 * (n % 7), slice.now()));
      slice.tick(-1.0);
    }
  });
}

}  // namespace
}  // namespace ergotic::tgr
