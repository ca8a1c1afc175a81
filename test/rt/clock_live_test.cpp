// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/rt/clock.hpp"

#include <signal.h>
#include <unistd.h>

#include <random>

#include "support/test.hpp"

namespace ergotic::rt {
namespace {

constexpr double kNominal = 44100.0;
constexpr std::int64_t kPeriod = 256;

/// A sound card that runs `ppm` too fast, read with a jitter, from an arbitrary start.
class Card {
 public:
  Card(double ppm, double jitter_rms_ns, std::int64_t first_frame, std::int64_t first_ns)
      : rate_(kNominal * (1.0 + ppm * 1e-6)),
        jitter_(0.0, jitter_rms_ns),
        first_frame_(first_frame),
        first_ns_(first_ns) {}

  double rate() const { return rate_; }
  std::int64_t trueTime(std::int64_t frame) const {
    return first_ns_ + std::llround(static_cast<double>(frame - first_frame_) * 1e9 / rate_);
  }
  FrameTime reading(std::int64_t period) {
    const std::int64_t frame = first_frame_ + period * kPeriod;
    return {frame, trueTime(frame) + (jitter_.stddev() > 0 ? std::llround(jitter_(random_)) : 0)};
  }

 private:
  double rate_;
  std::normal_distribution<double> jitter_;
  std::mt19937_64 random_{7};
  std::int64_t first_frame_;
  std::int64_t first_ns_;
};

struct Errors {
  double worst_phase_ns = 0.0;
  double worst_rate_ppm = 0.0;
};

/// Runs a clock for `seconds`, the errors taken over its last half.
Errors track(FrameClock& clock, Card& card, double seconds) {
  const auto periods = static_cast<std::int64_t>(seconds * kNominal / kPeriod);
  Errors errors;
  for (std::int64_t i = 0; i < periods; ++i) {
    const FrameTime reading = card.reading(i);
    clock.update(reading);
    if (i > periods / 2) {
      const auto phase =
          static_cast<double>(clock.timeOf(reading.frames) - card.trueTime(reading.frames));
      errors.worst_phase_ns = std::max(errors.worst_phase_ns, std::abs(phase));
      const double rate = std::abs(clock.frameRateHz() / card.rate() - 1.0) * 1e6;
      errors.worst_rate_ppm = std::max(errors.worst_rate_ppm, rate);
    }
  }
  return errors;
}

TEST(FrameClockTest, FindsAConstantRateErrorExactlyWithoutJitter) {
  Card card(80.0, 0.0, 0, 1'000'000'000);
  FrameClock clock(kNominal, 0.2);
  const Errors errors = track(clock, card, 120.0);
  EXPECT_LT(errors.worst_phase_ns, 2.0);
  EXPECT_LT(errors.worst_rate_ppm, 0.01);
  EXPECT_EQ(clock.relocks(), 0);
}

TEST(FrameClockTest, SmoothsJitterWhileFollowingARateError) {
  constexpr double kBandwidth = 0.2;
  constexpr double kJitterNs = 50'000.0;
  Card card(80.0, kJitterNs, 12'345, 5'000'000'000);
  FrameClock clock(kNominal, kBandwidth);
  const Errors errors = track(clock, card, 120.0);
  // Noise bandwidth of the loop: 3 omega / (2 sqrt 2) of the jitter's power, omega per update.
  const double omega = 2.0 * M_PI * kBandwidth * kPeriod / kNominal;
  const double expected_rms_ns = kJitterNs * std::sqrt(3.0 * omega / (2.0 * M_SQRT2));
  EXPECT_LT(errors.worst_phase_ns, 5.0 * expected_rms_ns);
  EXPECT_LT(errors.worst_rate_ppm, 15.0);
  EXPECT_EQ(clock.relocks(), 0);
}

TEST(FrameClockTest, KeepsNanosecondsAfterAYearOfUptime) {
  constexpr std::int64_t kYearNs = 365LL * 86'400 * 1'000'000'000;
  constexpr std::int64_t kYearFrames = 365LL * 86'400 * 44'100;
  Card card(-30.0, 0.0, kYearFrames, kYearNs);
  FrameClock clock(kNominal, 0.2);
  EXPECT_LT(track(clock, card, 120.0).worst_phase_ns, 2.0);
}

TEST(FrameClockTest, TimeOfAndFrameAtAreInverse) {
  Card card(80.0, 50'000.0, 1'000'000, 77'000'000'123);
  FrameClock clock(kNominal, 0.2);
  track(clock, card, 10.0);
  for (std::int64_t frame = 900'000; frame < 2'000'000; frame += 31'337) {
    // Half a nanosecond of rounding is 2.2e-5 frames.
    EXPECT_NEAR(clock.frameAt(clock.timeOf(frame)), static_cast<double>(frame), 3e-5);
  }
}

TEST(FrameClockTest, GoesOnThroughLostCyclesWithoutRelocking) {
  Card card(80.0, 0.0, 0, 1'000'000'000);
  FrameClock clock(kNominal, 0.2);
  track(clock, card, 60.0);
  const auto next = static_cast<std::int64_t>(60.0 * kNominal / kPeriod);
  const FrameTime after_gap = card.reading(next + 40);
  clock.update(after_gap);
  EXPECT_EQ(clock.relocks(), 0);
  EXPECT_NEAR(static_cast<double>(clock.timeOf(after_gap.frames) - after_gap.time_ns), 0.0, 5.0);
}

TEST(FrameClockTest, RelocksAtOnceAfterAJumpAndKeepsItsRate) {
  Card card(80.0, 0.0, 0, 1'000'000'000);
  FrameClock clock(kNominal, 0.2);
  track(clock, card, 120.0);
  FrameTime jumped = card.reading(30'000);
  jumped.time_ns += 100'000'000;
  clock.update(jumped);
  EXPECT_EQ(clock.relocks(), 1);
  EXPECT_EQ(clock.timeOf(jumped.frames), jumped.time_ns);
  EXPECT_NEAR(clock.frameRateHz(), card.rate(), card.rate() * 1e-7);
}

TEST(FrameClockTest, RelocksWhenAnotherServerCountsFromZero) {
  FrameClock clock(kNominal, 0.2);
  clock.update({1'000'000, 50'000'000'000});
  clock.update({0, 53'000'000'000});
  EXPECT_EQ(clock.relocks(), 1);
  EXPECT_EQ(clock.timeOf(0), 53'000'000'000);
}

TEST(FrameClockTest, IgnoresAReadingOfTheSameFrame) {
  FrameClock clock(kNominal, 0.2);
  clock.update({1000, 1'000'000});
  clock.update({1000, 1'500'000});
  EXPECT_EQ(clock.timeOf(1000), 1'000'000);
  EXPECT_DOUBLE_EQ(clock.frameRateHz(), kNominal);
}

TEST(FrameClockTest, ForgetsPhaseAndRateOnReset) {
  Card card(80.0, 0.0, 0, 1'000'000'000);
  FrameClock clock(kNominal, 0.2);
  EXPECT_FALSE(clock.isLocked());
  track(clock, card, 60.0);
  EXPECT_TRUE(clock.isLocked());
  clock.reset();
  EXPECT_FALSE(clock.isLocked());
  EXPECT_DOUBLE_EQ(clock.frameRateHz(), kNominal);
}

volatile sig_atomic_t alarms = 0;
void onAlarm(int) {
  alarms = alarms + 1;
}

TEST(SleepUntilNsTest, NeverWakesBeforeItsTimeEvenIfInterrupted) {
  struct sigaction action {};
  action.sa_handler = onAlarm;  // without SA_RESTART
  struct sigaction before {};
  sigaction(SIGALRM, &action, &before);
  ualarm(2'000, 2'000);
  const std::int64_t deadline = monotonicNs() + 100'000'000;
  sleepUntilNs(deadline);
  const std::int64_t woken = monotonicNs();
  ualarm(0, 0);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_GE(woken, deadline);
  EXPECT_GE(alarms, 1);
}

TEST(SleepUntilNsTest, ReturnsForATimeThatIsPast) {
  const std::int64_t now = monotonicNs();
  sleepUntilNs(now - 1'000'000'000);
  sleepUntilNs(0);
  EXPECT_GE(monotonicNs(), now);
}

}  // namespace
}  // namespace ergotic::rt
