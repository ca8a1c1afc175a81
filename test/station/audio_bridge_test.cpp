// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/audio_bridge.hpp"

#include <map>
#include <random>

#include "ergotic/station/tick_schedule.hpp"
#include "support/audio_host.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

constexpr double kRate = 44100.0;
constexpr int kRatio = 14;
constexpr std::uint32_t kPeriod = 256;
constexpr double kTickNs = 1e9 * kRatio / kRate;

AudioBridgeConfig smallConfig() {
  AudioBridgeConfig config;
  config.rates = {kRate, kRatio};
  config.output_channels = 2;
  config.input_channels = 1;
  return config;
}

/// A bridge between a host and a tick thread that are both driven by hand, on a clock of the test.
/// Station frame f carries the sample f + 1, so that no pushed sample is zero.
struct Rig {
  explicit Rig(const AudioBridgeConfig& config = smallConfig())
      : bridge(config), host(bridge, 2, 1, kRate), schedule(kTickNs, 5'000'000) {}

  /// All ticks due before the next block begins, then the block.
  std::vector<float> step(float input = 0.0F) {
    runTicksUntil(host.timeOf(host.nextFrame()));
    return hear(input);
  }

  void runTicksUntil(std::int64_t now_ns) {
    while (schedule.dueNs() < now_ns) {
      bridge.track(tick, schedule.dueNs());
      if (bridge.isMaster()) {
        schedule.follow(bridge.dueNs(tick));
      }
      runTick();
      schedule.advance(1);
    }
  }

  void runTick() {
    std::vector<float> in(kRatio, -1.0F);
    heard = bridge.pull(tick * kRatio, in.data(), kRatio);
    for (int i = 0; i < kRatio; ++i) {
      pulled[tick * kRatio + i] = in[static_cast<std::size_t>(i)];
    }
    std::vector<float> frames;
    for (int i = 0; i < kRatio; ++i) {
      frames.insert(frames.end(), 2, static_cast<float>(tick * kRatio + i + 1));
    }
    bridge.push(tick * kRatio, frames.data(), kRatio);
    ++tick;
    takeEvents();
  }

  std::vector<float> hear(float input = 0.0F) {
    const std::int64_t first = host.nextFrame();
    const std::vector<float> out = host.period(input);
    for (std::size_t i = 0; i < out.size(); ++i) {
      sounded[first + static_cast<std::int64_t>(i)] = out[i];
    }
    return out;
  }

  void takeEvents() {
    Event event;
    while (bridge.popEvent(event)) {
      events.push_back(event);
    }
  }

  /// Blocks until the bridge is connected and sounding.
  void settle() {
    for (int i = 0; i < 20; ++i) {
      step();
    }
    ASSERT_TRUE(bridge.isMaster());
  }

  const Event& started() const {
    return *std::find_if(events.begin(), events.end(),
                         [](const Event& e) { return e.type == Event::Type::kAudioStarted; });
  }
  std::int64_t offset() const {
    return static_cast<std::int64_t>(started().value) - started().frame;
  }

  /// Every host frame since the start of audio carries its own station frame, but for exactly those
  /// that were reported missing, which are zero.
  void expectExactExceptReported() {
    takeEvents();
    std::map<std::int64_t, bool> reported;
    for (const Event& e : events) {
      for (std::int64_t i = 0; e.type == Event::Type::kUnderrun && i < e.index; ++i) {
        EXPECT_EQ(static_cast<std::int64_t>(e.value), e.frame + offset());
        EXPECT_FALSE(reported[e.frame + i + offset()]) << "reported twice";
        reported[e.frame + i + offset()] = true;
      }
    }
    for (const auto& [frame, sample] : sounded) {
      const std::int64_t station_frame = frame - offset();
      const bool silent = station_frame < started().frame || reported.count(frame) != 0;
      ASSERT_EQ(sample, silent ? 0.0F : static_cast<float>(station_frame + 1)) << "at " << frame;
    }
    EXPECT_EQ(bridge.status().underrun_frames, static_cast<std::int64_t>(reported.size()));
  }

  AudioBridge bridge;
  test::AudioHost host;
  TickSchedule schedule;
  std::int64_t tick = 0;
  bool heard = false;
  std::map<std::int64_t, float> sounded;  // host frame -> sample
  std::map<std::int64_t, float> pulled;   // station frame -> sample
  std::vector<Event> events;
};

TEST(AudioBridgeTest, SoundsEveryFrameAtItsPlaceWithoutUnderrun) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  for (int i = 0; i < 2000; ++i) {
    rig.step();
  }
  rig.expectExactExceptReported();
  EXPECT_EQ(rig.bridge.status().underruns, 0);
  EXPECT_TRUE(rig.bridge.status().clock_locked);
  EXPECT_EQ(rig.events.size(), 1U) << "audio started, nothing else";
}

TEST(AudioBridgeTest, TickIsDueOneRingDepthBeforeItsFirstFrameSounds) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  const std::int64_t sounds_at = rig.tick * kRatio + rig.offset();
  EXPECT_NEAR(static_cast<double>(rig.bridge.dueNs(rig.tick)),
              static_cast<double>(rig.host.timeOf(sounds_at - 768)), 2000.0);
}

TEST(AudioBridgeTest, ConnectsWithinHalfAFrameOfTheTimesAtWhichTicksWereDue) {
  Rig rig;
  rig.host.start(kPeriod, 77, 23'456'789);
  while (!rig.bridge.isMaster()) {
    rig.step();
  }
  EXPECT_LE(std::abs(static_cast<double>(rig.bridge.dueNs(rig.tick) - rig.schedule.dueNs())),
            0.5 * 1e9 / kRate + 1000.0);
}

TEST(AudioBridgeTest, SkippedPushesAreZerosExactlyWhereReported) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  rig.tick += 5;  // ticks that never ran
  rig.schedule.advance(5);
  for (int i = 0; i < 50; ++i) {
    rig.step();
  }
  rig.expectExactExceptReported();
  EXPECT_EQ(rig.bridge.status().underruns, 1);
  EXPECT_EQ(rig.bridge.status().underrun_frames, 5 * kRatio);
}

TEST(AudioBridgeTest, TellsOfTheVeryFirstFramesThatAreMissing) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  while (!rig.bridge.isMaster()) {
    rig.hear();
    rig.bridge.track(rig.tick, rig.schedule.dueNs());
    if (!rig.bridge.isMaster()) {
      rig.runTicksUntil(rig.host.timeOf(rig.host.nextFrame()));
    }
  }
  rig.tick += 2;  // ticks that never ran
  rig.schedule.advance(2);
  for (int i = 0; i < 50; ++i) {
    rig.step();
  }
  rig.expectExactExceptReported();
  EXPECT_EQ(rig.bridge.status().underrun_frames, 2 * kRatio);
}

TEST(AudioBridgeTest, DiscardsWhatComesTooLateAndNeverShifts) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  for (int i = 0; i < 6; ++i) {
    rig.hear();  // the tick thread stands still for 1536 frames, twice the ring depth
  }
  for (int i = 0; i < 50; ++i) {
    rig.step();
  }
  rig.expectExactExceptReported();
  EXPECT_EQ(rig.bridge.status().underruns, 1) << "one gap, though it spans several blocks";
  EXPECT_NEAR(static_cast<double>(rig.bridge.status().underrun_frames), 768.0 + 256.0, 256.0);
}

TEST(AudioBridgeTest, TellsWhatTheHostLeftOut) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  const std::int64_t expected = rig.host.nextFrame();
  rig.host.skip(512);
  rig.bridge.xrun();
  for (int i = 0; i < 50; ++i) {
    rig.step();
  }
  rig.expectExactExceptReported();
  const auto skipped = std::find_if(rig.events.begin(), rig.events.end(), [](const Event& e) {
    return e.type == Event::Type::kAudioSkipped;
  });
  ASSERT_NE(skipped, rig.events.end());
  EXPECT_EQ(skipped->frame, expected - rig.offset());
  EXPECT_EQ(skipped->index, 512);
  EXPECT_EQ(static_cast<std::int64_t>(skipped->value), expected) << "in frames of the host";
  EXPECT_EQ(rig.bridge.status().xruns, 1);
  EXPECT_EQ(rig.bridge.status().underruns, 0);
}

class AudioBridgeScheduleTest : public ::testing::TestWithParam<unsigned> {};

TEST_P(AudioBridgeScheduleTest, IsExactWhereverItReportsNoUnderrun) {
  std::mt19937 random(GetParam());
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  std::uniform_int_distribution<int> kind(0, 19);
  std::uniform_int_distribution<std::int64_t> some(1, 150);
  for (int i = 0; i < 2000; ++i) {
    switch (kind(random)) {
      case 0: {
        const std::int64_t lost = some(random);  // ticks that never ran
        rig.tick += lost;
        rig.schedule.advance(lost);
        break;
      }
      case 1:
        rig.hear();  // the tick thread is late for this block
        break;
      case 2:
        rig.host.skip(some(random));
        break;
      case 3:  // the tick thread is early
        rig.runTicksUntil(rig.schedule.dueNs() + some(random) * 20'000);
        break;
      default:
        rig.step();
    }
  }
  rig.expectExactExceptReported();
  EXPECT_GT(rig.bridge.status().underruns, 10);
  EXPECT_EQ(rig.bridge.status().dropped_records, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AudioBridgeScheduleTest, ::testing::Range(1U, 11U));

TEST(AudioBridgeTest, ReconnectsToAHostThatCountsFromElsewhere) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  rig.step(0.5F);
  const std::int64_t gone_at = rig.host.timeOf(rig.host.nextFrame());
  rig.bridge.audioStopped();
  rig.runTicksUntil(gone_at + 50'000'000);
  EXPECT_FALSE(rig.bridge.isMaster());
  EXPECT_EQ(rig.events.back().type, Event::Type::kAudioStopped);
  EXPECT_FALSE(rig.bridge.status().running);

  rig.events.clear();
  rig.sounded.clear();
  rig.pulled.clear();
  rig.host.start(kPeriod, 64, gone_at + 60'000'000);
  rig.settle();
  for (int i = 0; i < 50; ++i) {
    rig.step(0.25F);
  }
  rig.expectExactExceptReported();
  EXPECT_EQ(rig.bridge.status().underruns, 0);
  EXPECT_EQ(rig.pulled.rbegin()->second, 0.25F);
}

TEST(AudioBridgeTest, IsSilentWithoutUnderrunsOnceTicksEnd) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  rig.bridge.disconnect();
  for (int i = 0; i < 10; ++i) {
    const auto out = rig.hear();
    EXPECT_TRUE(std::all_of(out.begin(), out.end(), [](float s) { return s == 0.0F; }));
  }
  EXPECT_EQ(rig.bridge.status().underruns, 0);
}

TEST(AudioBridgeTest, CaptureReachesTicksAtAConstantDistance) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  // An impulse at the start of one block arrives at exactly one station frame.
  rig.runTicksUntil(rig.host.timeOf(rig.host.nextFrame()));
  const std::int64_t at = rig.host.nextFrame();
  std::vector<float> impulse(kPeriod, 0.0F);
  impulse[0] = 1.0F;
  rig.host.period(impulse);
  for (int i = 0; i < 10; ++i) {
    rig.step();
  }
  std::vector<std::int64_t> found;
  for (const auto& [frame, sample] : rig.pulled) {
    if (sample != 0.0F) {
      found.push_back(frame);
    }
  }
  ASSERT_EQ(found.size(), 1U);
  const std::int64_t lag = static_cast<std::int64_t>(kPeriod) + kRatio;
  EXPECT_EQ(found[0] + rig.offset() - 768 - lag, at);
}

TEST(AudioBridgeTest, TellsSilenceFromSoundAtTheInput) {
  Rig rig;
  rig.host.start(kPeriod, 1'000'000, 20'000'000);
  rig.settle();
  EXPECT_FALSE(rig.heard);
  for (int i = 0; i < 5; ++i) {
    rig.step(0.5F);
  }
  EXPECT_TRUE(rig.heard);
}

TEST(AudioBridgeTest, FillsHostChannelsThatTheStationDoesNotHave) {
  AudioBridge bridge(smallConfig());
  test::AudioHost host(bridge, 5, 0, kRate);
  host.start(64, 0, 0);
  host.period();
  for (const auto& channel : host.last()) {
    EXPECT_TRUE(std::all_of(channel.begin(), channel.end(), [](float s) { return s == 0.0F; }));
  }
}

TEST(AudioBridgeTest, RaisesARingDepthThatTheHostsPeriodExceeds) {
  Rig rig;
  rig.host.start(1024, 1'000'000, 20'000'000);
  EXPECT_EQ(rig.bridge.latencyFrames(), 1024 + kRatio + AudioBridge::kMarginFrames);
  EXPECT_EQ(rig.bridge.takeWarnings().size(), 1U);
  EXPECT_TRUE(rig.bridge.takeWarnings().empty());
  for (int i = 0; i < 200; ++i) {
    rig.step();
  }
  rig.expectExactExceptReported();
  EXPECT_EQ(rig.bridge.status().underruns, 0);
}

TEST(AudioBridgeTest, RefusesAHostAtAnotherRateOrWithAnEndlessPeriod) {
  AudioBridge bridge(smallConfig());
  EXPECT_THROW(bridge.audioStarted(48000.0, 256), Exception);
  EXPECT_THROW(bridge.audioStarted(kRate, 1U << 15U), Exception);
  EXPECT_FALSE(bridge.status().running);
}

TEST(AudioBridgeTest, RefusesARingDepthOutsideItsRange) {
  AudioBridgeConfig config = smallConfig();
  config.latency_frames = 0;
  EXPECT_THROW(AudioBridge{config}, Exception);
  config.latency_frames = AudioBridge::kMaxLatencyFrames + 1;
  EXPECT_THROW(AudioBridge{config}, Exception);
}

TEST(AudioBridgeTest, KeepsTheSoundBelowFullScaleIfItShallAndSaysSoOnce) {
  AudioBridgeConfig config = smallConfig();
  config.limited = true;
  Rig rig(config);  // whose samples are the numbers of their frames
  rig.host.start(kPeriod, 5000, 7'000'000);
  for (int n = 0; n < 100; ++n) {
    rig.step();
  }
  float loudest = 0.0F;
  for (const auto& [frame, sample] : rig.sounded) {
    loudest = std::max(loudest, sample);
  }
  EXPECT_GT(loudest, 0.9F);
  EXPECT_LE(static_cast<double>(loudest), Limiter::kCeiling * 1.000001);
  EXPECT_GT(rig.bridge.loudness().peak, 1000.0F);
  EXPECT_GT(rig.bridge.loudness().limited_frames, 1000);
  EXPECT_THAT(
      rig.bridge.takeWarnings(),
      Contains(HasSubstr("dBFS so far; what is above -0.2 dBFS is turned down by the limiter")));
  EXPECT_THAT(rig.bridge.takeWarnings(), IsEmpty());
}

TEST(AudioBridgeTest, TheVolumeIsReachedWithin20MsAndAtOnePassesBitForBit) {
  AudioBridgeConfig config = smallConfig();
  Rig rig(config);  // whose samples are the numbers of their frames
  rig.host.start(kPeriod, 5000, 7'000'000);
  for (int n = 0; n < 40; ++n) {
    rig.step();
  }
  for (const auto& [frame, sample] : rig.sounded) {
    EXPECT_TRUE(sample == 0.0F || sample == std::floor(sample)) << "whole numbers, as they were";
  }
  rig.bridge.setVolume(0.0F);
  for (int n = 0; n < 40; ++n) {
    rig.step();
  }
  rig.sounded.clear();
  rig.bridge.takePeaks();
  for (int n = 0; n < 10; ++n) {
    rig.step();
  }
  ASSERT_FALSE(rig.sounded.empty());
  for (const auto& [frame, sample] : rig.sounded) {
    EXPECT_EQ(sample, 0.0F);
  }
  EXPECT_EQ(rig.bridge.takePeaks().front(), 0.0F);
  rig.bridge.setVolume(0.5F);
  for (int n = 0; n < 60; ++n) {
    rig.step();
  }
  EXPECT_GT(rig.bridge.takePeaks().front(), 100.0F);
  EXPECT_EQ(rig.bridge.takePeaks().front(), 0.0F) << "since the last call";
}

TEST(AudioBridgeTest, TheScopeSeesWhatSoundsWithTheVolume) {
  Rig rig;
  rig.host.start(kPeriod, 5000, 7'000'000);
  rig.settle();
  rig.bridge.setVolume(0.5F);
  for (int n = 0; n < 20; ++n) {
    rig.step();
  }
  EXPECT_FALSE(rig.bridge.scope().refresh()) << "nobody has asked";
  rig.sounded.clear();
  rig.bridge.scope().watch(true);
  for (std::size_t n = 0; n < OutputScope::kFrames / kPeriod; ++n) {
    rig.step();
  }
  ASSERT_TRUE(rig.bridge.scope().refresh());
  ASSERT_EQ(rig.sounded.size(), OutputScope::kFrames);
  const std::vector<float>& seen = rig.bridge.scope().latest();
  std::size_t i = 0;
  for (const auto& [frame, sample] : rig.sounded) {
    ASSERT_EQ(seen[i], sample) << "at " << frame;
    ASSERT_EQ(seen[OutputScope::kFrames + i], sample) << "both channels play the same";
    ++i;
  }
  EXPECT_GT(seen[0], 0.0F);
}

TEST(AudioBridgeTest, ATakeSoundsBesideTheInstrument) {
  Rig rig;  // whose samples are the numbers of their frames, from 1 on
  rig.host.start(kPeriod, 5000, 7'000'000);
  rig.settle();
  TakePort& takes = *rig.bridge.takes();
  takes.open();
  const std::vector<float> quarters(2 * std::size_t{8 * kPeriod}, 0.25F);
  ASSERT_TRUE(takes.push(quarters.data(), 8 * kPeriod));
  rig.step();  // it fades in within 221 frames
  rig.sounded.clear();
  for (int n = 0; n < 7; ++n) {
    rig.step();
  }
  ASSERT_EQ(rig.sounded.size(), std::size_t{7 * kPeriod});
  for (const auto& [frame, sample] : rig.sounded) {
    ASSERT_EQ(sample, static_cast<float>(frame - rig.offset() + 1) + 0.25F) << "at " << frame;
  }
  rig.sounded.clear();
  rig.step();
  for (const auto& [frame, sample] : rig.sounded) {
    ASSERT_EQ(sample, static_cast<float>(frame - rig.offset() + 1)) << "it has ended";
  }
  EXPECT_EQ(rig.bridge.status().underruns, 0);
}

TEST(AudioBridgeTest, MidiMessagesKeepTheirDistancesToTheFrame) {
  Rig rig;
  rig.host.start(kPeriod, 5000, 7'000'000);
  MidiArrival arrival;
  rig.host.send({17, 3, {0x90, 60, 100}});
  rig.step();
  ASSERT_TRUE(rig.bridge.popMidi(arrival));
  EXPECT_TRUE(std::isnan(arrival.tick)) << "no ticks are tied to these frames yet";
  rig.settle();
  for (std::uint32_t offset = 0; offset < kPeriod; offset += 51) {
    const std::int64_t frame = rig.host.nextFrame() + offset;
    rig.host.send({offset, 3, {0x90, 60, 100}});
    rig.step();
    ASSERT_TRUE(rig.bridge.popMidi(arrival));
    EXPECT_DOUBLE_EQ(arrival.tick * kRatio,
                     static_cast<double>(frame - rig.offset() + rig.bridge.latencyFrames()));
    // That tick is due by the clock of the host when the frame begins, to a tick.
    const std::int64_t due_ns = rig.bridge.dueNs(static_cast<std::int64_t>(arrival.tick));
    EXPECT_NEAR(static_cast<double>(due_ns - rig.host.timeOf(frame)), -0.5 * kTickNs,
                0.51 * kTickNs);
    EXPECT_FALSE(rig.bridge.popMidi(arrival));
  }
}

}  // namespace
}  // namespace ergotic::station
