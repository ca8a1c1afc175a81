// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/jack/jack_ticks.hpp"

#include "support/audio_host.hpp"
#include "support/realtime_scope.hpp"
#include "support/test.hpp"
#include "tgr_jack/jack_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::AudioHost;
using test::kJackPeriod;
using test::kJackRate;

constexpr int kRatio = 16;
constexpr double kTickRateHz = static_cast<double>(kJackRate) / kRatio;

/// Force n of the only slice goes out with tick n + 1, like a station's.
class Log : public TickTarget {
 public:
  explicit Log(JackTicks& ticks) : ticks_(ticks) { positions.reserve(1U << 12U); }
  void tick(std::int64_t late_ns) noexcept override {
    exchange();
    late.push_back(late_ns);
  }
  void missed(std::int64_t count, std::int64_t stall_ns) noexcept override {
    missed_ticks += count;
    missed_ns += stall_ns;
    exchange();
  }

  std::function<double(double position)> law = [](double) { return 0.0; };
  std::function<void()> then = [] {};  ///< after each exchange
  std::vector<double> positions;
  std::vector<std::int64_t> late;
  std::uint32_t flags = 0;  ///< of the last exchange
  std::int64_t missed_ticks = 0;
  std::int64_t missed_ns = 0;

 private:
  void exchange() {
    double position = 0.0;
    flags = ticks_.exchange(&force_, &position);
    positions.push_back(position);
    force_ = law(position);
    then();
  }
  JackTicks& ticks_;
  double force_ = 0.0;
};

class JackTicksTest : public ::testing::Test {
 protected:
  JackTicksTest() {
    ticks_.open(kTickRateHz);
    host_.start(kJackPeriod, 1000, 0);
    ticks_.start(log_);
  }
  static std::vector<float> ramp() {
    std::vector<float> samples(kJackPeriod);
    for (std::size_t i = 0; i < kJackPeriod; ++i) {
      samples[i] = static_cast<float>(i) / 256.0F;
    }
    return samples;
  }
  std::string refusalOf(double rate_hz, std::uint32_t period) {
    try {
      ticks_.audioStarted(rate_hz, period);
    } catch (const Exception& error) {
      EXPECT_EQ(ticks_.refusal(), error.what());
      return error.what();
    }
    return ticks_.refusal() + "accepted";
  }

  JackTicks ticks_{1, 10.0};
  Log log_{ticks_};
  AudioHost host_{ticks_, 2, 1, kJackRate};
};

TEST_F(JackTicksTest, ReadsTheMeanOfTheFramesOfATickInVolts) {
  host_.period(ramp());
  ASSERT_EQ(log_.positions.size(), kJackPeriod / kRatio);
  for (std::size_t k = 0; k < log_.positions.size(); ++k) {
    const double mean = (static_cast<double>(k * kRatio) + 0.5 * (kRatio - 1)) / 256.0;
    EXPECT_DOUBLE_EQ(log_.positions[k], 10.0 * mean);
  }
  EXPECT_EQ(log_.flags, 0U);
}

TEST_F(JackTicksTest, HoldsTheForceOfATickOverTheFramesOfTheNext) {
  log_.law = [](double volts) { return -volts; };
  const std::vector<float> first = host_.period(ramp());
  const std::vector<float> second = host_.period(0.0F);
  for (std::size_t i = 0; i < kJackPeriod; ++i) {
    const auto tick = static_cast<float>(i / kRatio);
    EXPECT_EQ(first[i], tick == 0.0F ? 0.0F : -((tick - 1.0F) * 16.0F + 7.5F) / 256.0F) << i;
  }
  const float last_of_first = -(48.0F + 7.5F) / 256.0F;
  for (std::size_t i = 0; i < kJackPeriod; ++i) {
    EXPECT_EQ(second[i], i < kRatio ? last_of_first : 0.0F) << i;
  }
}

TEST_F(JackTicksTest, ClipsForcesToFullScaleAndGivesNoneForWhatIsNoNumber) {
  for (const auto& [volts, units] : {std::pair{1e308, 1.0F},
                                     {-11.0, -1.0F},
                                     {std::numeric_limits<double>::infinity(), 1.0F},
                                     {std::numeric_limits<double>::quiet_NaN(), 0.0F}}) {
    log_.law = [volts = volts](double) { return volts; };
    host_.period();
    EXPECT_EQ(host_.period()[5], units);
  }
}

TEST_F(JackTicksTest, GivesNoForceFromTheBlockOfAMakeSafeOn) {
  log_.law = [](double) { return 5.0; };
  host_.period();
  EXPECT_EQ(host_.period(), std::vector<float>(kJackPeriod, 0.5F));
  int exchanges = 0;
  log_.then = [&] {
    if (++exchanges == 3) {
      ticks_.makeSafe();  // two ticks of this block have given their force already
    }
  };
  EXPECT_EQ(host_.period(), std::vector<float>(kJackPeriod, 0.0F));
  EXPECT_EQ(host_.period(), std::vector<float>(kJackPeriod, 0.0F));
  EXPECT_EQ(log_.flags, kMadeSafe);
  ticks_.rearm();
  EXPECT_EQ(host_.period()[0], 0.5F);
}

TEST_F(JackTicksTest, BeatsOnceABlockWhileForceMayCome) {
  const auto beat = [&] {
    host_.period();
    return host_.last()[1];
  };
  const std::vector<float> up(kJackPeriod, JackTicks::kHeartbeat);
  const std::vector<float> down(kJackPeriod, -JackTicks::kHeartbeat);
  const std::vector<float> none(kJackPeriod, 0.0F);
  EXPECT_EQ(beat(), down);
  EXPECT_EQ(beat(), up);
  ticks_.makeSafe();
  EXPECT_EQ(beat(), none);
  ticks_.rearm();
  EXPECT_EQ(beat(), down);
  ticks_.stop();
  EXPECT_EQ(beat(), none);
}

TEST_F(JackTicksTest, FallsSilentWhenTheClockIsStoppedAndTakesNoForceOutsideOfTicks) {
  log_.law = [](double) { return 5.0; };
  host_.period();
  host_.period();
  ticks_.stop();
  const double force = 5.0;
  double position = 77.0;
  EXPECT_EQ(ticks_.exchange(&force, &position), kMissingSample);
  EXPECT_EQ(position, log_.positions.back());
  const std::size_t seen = log_.positions.size();
  EXPECT_EQ(host_.period(), std::vector<float>(kJackPeriod, 0.0F));
  EXPECT_EQ(log_.positions.size(), seen);
  ticks_.stop();
  ticks_.start(log_);
  host_.skip(kJackPeriod);
  host_.period();
  EXPECT_GT(log_.positions.size(), seen);
}

TEST_F(JackTicksTest, BurstsOnceABlock) {
  EXPECT_DOUBLE_EQ(ticks_.periodS(), static_cast<double>(kJackPeriod) / kJackRate);
}

TEST_F(JackTicksTest, CountsFramesThatTheHostLeftOutAsMissedTicks) {
  host_.period();
  host_.skip(2 * kJackPeriod + 24);
  host_.period(0.5F);
  EXPECT_EQ(log_.missed_ticks, 9) << "and half a tick is owed";
  EXPECT_EQ(log_.missed_ns, std::llround(152 * 1e9 / kJackRate));
  EXPECT_EQ(log_.positions[4], 5.0) << "the newest sample serves what was missed";
  EXPECT_EQ(log_.positions.size(), 4U + 1U + 4U);
  host_.skip(8);
  host_.period();
  EXPECT_EQ(log_.missed_ticks, 10);
}

TEST_F(JackTicksTest, CountsNothingAsMissedWhereTwoBlocksHaveOneTime) {
  host_.period();
  host_.skip(kJackPeriod);  // a late block gets the time of the next...
  host_.period();
  EXPECT_EQ(log_.missed_ticks, 4);
  for (int n = 0; n < 5; ++n) {  // ...which has it too, again and again
    host_.skip(-static_cast<std::int64_t>(kJackPeriod));
    host_.period();
    host_.skip(kJackPeriod);
    host_.period();
  }
  EXPECT_EQ(log_.missed_ticks, 4) << "no tick is missed twice";
}

TEST_F(JackTicksTest, CountsTheTimeWithoutAServerAsMissedTicks) {
  host_.period();  // ends at 1064 / 48 kHz from the host's origin, which is its time 0
  ticks_.audioStopped();
  const double force = 1.0;
  double position = 0.0;
  EXPECT_EQ(ticks_.exchange(&force, &position), kDeviceLost);
  constexpr std::int64_t kBreakNs = 2'000'000'000;
  const std::int64_t end_ns = host_.timeOf(host_.nextFrame());
  host_.start(kJackPeriod, 0, end_ns + kBreakNs);  // another server counts from zero
  host_.period();
  EXPECT_EQ(log_.missed_ticks, std::llround(2.0 * kTickRateHz));
}

TEST_F(JackTicksTest, MissesNothingBeforeItsClockIsStarted) {
  ticks_.stop();
  host_.period();
  host_.skip(1'000'000);
  ticks_.start(log_);
  host_.period();
  EXPECT_EQ(log_.missed_ticks, 0);
}

TEST_F(JackTicksTest, CallsTicksLateThatComeAfterTheirFramesWouldOneByOne) {
  const std::int64_t now_ns = rt::monotonicNs();
  constexpr std::int64_t kHourNs = 3'600'000'000'000;
  host_.start(kJackPeriod, 0, now_ns - kHourNs);
  log_.late.clear();
  host_.period();
  ASSERT_EQ(log_.late.size(), 4U);
  EXPECT_GE(log_.late.front(), kHourNs);
  host_.start(kJackPeriod, 0, rt::monotonicNs() + kHourNs);
  host_.period();
  EXPECT_LT(log_.late.back(), -kHourNs / 2) << "early, as the last ticks of a block are";
}

TEST_F(JackTicksTest, RefusesRatesAndPeriodsThatTicksDoNotFit) {
  EXPECT_EQ(refusalOf(44100.0, 64),
            "the JACK server runs at 44100 Hz, which is no multiple of the 3000 Hz of the ticks: "
            "start one of them at a rate that fits");
  EXPECT_EQ(refusalOf(kJackRate, 72),
            "the JACK server's period is 72 frames, a tick is 16, which does not divide it; "
            "allowed: 1, 2, 3, 4, 6, 8, 9, 12, 18, 24, 36 frames per tick, or a period that is a "
            "multiple of 16");
  EXPECT_EQ(refusalOf(kJackRate, 128), "accepted");
  ticks_.pin();
  EXPECT_NE(refusalOf(kJackRate, 64).find("changed from 128 to 64 frames"), std::string::npos);
  EXPECT_EQ(refusalOf(kJackRate, 128), "accepted");
}

/// A block of its own memory, for AudioHost makes its own.
class PlainBlock {
 public:
  explicit PlainBlock(bool wired) {
    block.nframes = kJackPeriod;
    block.inputs = inputs_;
    block.outputs = outputs_;
    block.input_channels = 1;
    block.output_channels = 2;
    block.wired = wired;
  }
  rt::Period block;
  float out[2][kJackPeriod]{};

 private:
  float in_[kJackPeriod]{};
  const float* inputs_[1] = {in_};
  float* outputs_[2] = {out[0], out[1]};
};

TEST_F(JackTicksTest, IsLostAndSilentWhileAWireIsMissing) {
  log_.law = [](double) { return 5.0; };
  PlainBlock good(true);
  PlainBlock bad(false);
  ticks_.process(good.block);
  ticks_.process(good.block);
  EXPECT_EQ(good.out[0][0], 0.5F);
  ticks_.process(bad.block);
  EXPECT_EQ(log_.flags, kDeviceLost);
  for (std::size_t i = 0; i < kJackPeriod; ++i) {
    ASSERT_EQ(bad.out[0][i], 0.0F);
    ASSERT_EQ(bad.out[1][i], 0.0F) << "nor does it beat";
  }
}

TEST_F(JackTicksTest, PlaysABlockInRealTime) {
  PlainBlock block(true);
  log_.late.reserve(1U << 12U);
  test::expectRealtime([&] {
    for (int n = 0; n < 500; ++n) {
      block.block.start.frames += n % 10 == 0 ? 2 * kJackPeriod : kJackPeriod;
      ticks_.process(block.block);
    }
  });
}

}  // namespace
}  // namespace ergotic::tgr
