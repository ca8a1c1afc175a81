// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <map>
#include <set>
#include <thread>

#include "ergotic/rt/clock.hpp"
#include "ergotic/station/timer_source.hpp"
#include "support/audio_host.hpp"
#include "support/reference_threads.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::station {
namespace {

using test::Bench;

/// What an operator asked for, and what came back.
struct Tally {
  std::map<Event::Type, std::int64_t> asked;
  std::map<Event::Type, std::int64_t> told;
  std::int64_t performers = 0;
  std::int64_t coefficients = 0;

  void take(Station& station) {
    Event event;
    while (station.poll(event)) {
      ++told[event.type];
      performers += event.performer != nullptr ? 1 : 0;
      coefficients += event.coefficients != nullptr ? 1 : 0;
      delete event.performer;
      delete event.coefficients;
    }
  }
};

/// Submits, polling while the station refuses, and remembers what must come back.
void submit(Station& station, Tally& tally, const Command& command, Event::Type answer) {
  while (!station.submit(command)) {
    tally.take(station);
    std::this_thread::yield();
  }
  ++tally.asked[answer];
}

/// One at a time.
void askForAKeyframe(Station& station, Tally& tally) {
  Command command;
  command.type = Command::Type::kKeyframe;
  if (tally.told[Event::Type::kKeyframe] == tally.asked[Event::Type::kKeyframe]) {
    submit(station, tally, command, Event::Type::kKeyframe);
  }
}

/// Until all but the engagements, which a stop may refuse, are answered.
bool isAnswered(Tally& tally) {
  return std::all_of(tally.asked.begin(), tally.asked.end(), [&](const auto& asked) {
    const bool may_be_refused = asked.first == Event::Type::kEngaged;
    const std::int64_t refused = may_be_refused ? tally.told[Event::Type::kRefused] : 0;
    return tally.told[asked.first] + refused == asked.second;
  });
}

TEST(StationThreadsTest, AnswersEveryCommandOfAStormExactlyOnce) {
  Bench bench;
  Station& station = *bench.station;
  std::atomic<bool> stop{false};
  std::thread tick([&] {
    while (!stop.load()) {
      station.cycle({0, true});
    }
  });
  Tally tally;
  constexpr std::int64_t kKeyframes = 10;
  auto prepared = test::makeSpring();
  std::int64_t ticks_recorded = 0;
  std::vector<GestureTick> gestures(256);
  for (int i = 0; i < 2000; ++i) {
    Command command;
    command.type = Command::Type::kEngage;
    submit(station, tally, command, Event::Type::kEngaged);
    command.type = Command::Type::kSwap;
    command.performer = test::makeSpring().release();
    submit(station, tally, command, Event::Type::kSwapped);
    command = Command{};
    command.type = Command::Type::kParameter;
    command.value = i;
    command.coefficients = prepared->instrument->prepare({command.value}).release();
    submit(station, tally, command, Event::Type::kParameter);
    askForAKeyframe(station, tally);
    station.stop();
    ticks_recorded +=
        static_cast<std::int64_t>(station.pollGestures(gestures.data(), gestures.size()));
    station.snapshot();
    tally.take(station);
  }
  while (!isAnswered(tally) || tally.asked[Event::Type::kKeyframe] <= kKeyframes) {
    if (tally.asked[Event::Type::kKeyframe] <= kKeyframes) {  // how many is up to the scheduler
      askForAKeyframe(station, tally);
    }
    tally.take(station);
    std::this_thread::yield();
  }
  stop.store(true);
  tick.join();
  tally.take(station);
  EXPECT_TRUE(isAnswered(tally)) << "and nothing twice";
  EXPECT_GT(tally.told[Event::Type::kStopped], 0);
  for (const auto& [type, asked] : tally.asked) {
    EXPECT_TRUE(asked == 2000 || (type == Event::Type::kKeyframe && asked > kKeyframes)) << asked;
  }
  EXPECT_EQ(tally.performers, 2000);
  EXPECT_EQ(tally.coefficients, 2000);
  EXPECT_GT(ticks_recorded, 0);
}

TEST(StationThreadsTest, CountsASlowDeviceByItsCause) {
  Bench bench;
  bench.driver->flags_of = [](std::int64_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return 0U;
  };
  bench.station->cycle({0, false});
  const auto events = bench.events();
  EXPECT_EQ(test::lateEvents(events, LateCause::kDevice), 1);
  EXPECT_EQ(test::lateEvents(events, LateCause::kWakeUp), 0);
}

TEST(StationThreadsTest, CountsNoTickAsLateInFreewheel) {
  Bench bench;
  bench.driver->flags_of = [](std::int64_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return 0U;
  };
  bench.run(3);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kLateTick), 0);
}

TEST(StationThreadsTest, MakeSafeFromAnotherThreadAlwaysWins) {
  Bench bench;
  Station& station = *bench.station;
  for (int i = 0; i < 200; ++i) {
    bench.command(Command::Type::kRecover);
    bench.command(Command::Type::kEngage);
    std::thread tick([&] { bench.run(500); });
    std::thread guard([&] { station.makeSafe(); });
    tick.join();
    guard.join();
    bench.run(2);
    ASSERT_EQ(bench.log.forces[0], 0.0) << "round " << i;
    ASSERT_TRUE(bench.interlock->read().isLatched());
    bench.events();
  }
}

TEST(StationThreadsTest, ARecoveryThatWasAskedForBeforeAnEmergencyStopNeverUndoesIt) {
  Bench bench;
  Station& station = *bench.station;
  std::atomic<bool> done{false};
  std::thread tick([&] {
    while (!done.load()) {
      station.cycle({0, true});
    }
  });
  Tally tally;
  for (int i = 1; i <= 500; ++i) {
    station.makeSafe(FaultReason::kWatchdog);
    Command recover;
    recover.type = Command::Type::kRecover;
    recover.asked = bench.interlock->ticket();
    std::thread guard([&] { station.makeSafe(FaultReason::kEmergencyStop); });
    ASSERT_TRUE(station.submit(recover));
    guard.join();
    while (tally.told[Event::Type::kRecovered] + tally.told[Event::Type::kRefused] < i) {
      tally.take(station);
      std::this_thread::yield();
    }
    ASSERT_TRUE(bench.interlock->read().isLatched()) << "round " << i;
    ASSERT_TRUE(bench.log.safe.load()) << "round " << i;
  }
  done.store(true);
  tick.join();
}

/// A host thread that paces itself by the clock, as a dummy sound card does.
class HostThread {
 public:
  HostThread(AudioBridge& bridge, int blocks) : host_(bridge, 2, 1, 44100.0) {
    const std::int64_t begin = rt::monotonicNs() + 5'000'000;
    host_.start(kPeriod, 5000, begin);
    thread_ = std::thread([this, blocks] {
      for (int i = 0; i < blocks; ++i) {
        rt::sleepUntilNs(host_.timeOf(host_.nextFrame()));
        first_.push_back(host_.nextFrame());
        heard_.push_back(host_.period());
      }
    });
  }
  void join() { thread_.join(); }

  /// From when the tick of a frame was due until its block was asked for.
  test::Trials::Window windowOf(std::int64_t frame, const AudioBridgeConfig& config) const {
    const std::int64_t into_block = (frame - first_.front()) % kPeriod;
    return {host_.timeOf(frame - config.latency_frames - config.rates.ratio),
            host_.timeOf(frame - into_block)};
  }

  /// Host frame -> sample.
  std::map<std::int64_t, float> sounded() const {
    std::map<std::int64_t, float> all;
    for (std::size_t b = 0; b < first_.size(); ++b) {
      for (std::size_t i = 0; i < heard_[b].size(); ++i) {
        all[first_[b] + static_cast<std::int64_t>(i)] = heard_[b][i];
      }
    }
    return all;
  }

 private:
  static constexpr std::uint32_t kPeriod = 256;
  test::AudioHost host_;
  std::vector<std::int64_t> first_;
  std::vector<std::vector<float>> heard_;
  std::thread thread_;
};

/// Puts the index of every station frame on the bridge, whatever the model says.
class IndexPort : public FramePort {
 public:
  explicit IndexPort(AudioBridge& bridge) : bridge_(bridge) {}
  void push(std::int64_t first, const float* /*frames*/, int nframes) noexcept override {
    std::array<float, 2 * physics::kMaxRatio> indices{};
    for (int i = 0; i < 2 * nframes; ++i) {
      indices[static_cast<std::size_t>(i)] = static_cast<float>(first + i / 2 + 1);
    }
    bridge_.push(first, indices.data(), nframes);
  }
  bool pull(std::int64_t first, float* frames, int nframes) noexcept override {
    return bridge_.pull(first, frames, nframes);
  }
  bool popEvent(Event& event) noexcept override { return bridge_.popEvent(event); }
  AudioStatus status() const noexcept override { return bridge_.status(); }

 private:
  AudioBridge& bridge_;
};

/// Host frames that were reported as not having sounded.
std::set<std::int64_t> reported(const std::vector<Event>& events, std::int64_t offset) {
  std::set<std::int64_t> missing;
  for (const Event& event : events) {
    for (std::int64_t i = 0; event.type == Event::Type::kUnderrun && i < event.index; ++i) {
      missing.insert(event.frame + i + offset);
    }
  }
  return missing;
}

// What does not sound has to be excused, frame by frame: by a stall between when its tick was due
// and when the host asked for it.
TEST(StationThreadsTest, LiveAudioIsExactExceptWhereUnderrunsAreReported) {
  const test::ReferenceThreads reference;
  Bench bench;
  AudioBridgeConfig config;
  config.rates = {44100.0, 14};
  config.output_channels = 2;
  config.input_channels = 1;
  AudioBridge bridge(config);
  IndexPort port(bridge);
  bench.station->setFramePort(&port);
  TimerSource timer(*bench.station, &bridge);
  TimerOptions options;
  options.priority = test::ReferenceThreads::kPriority - 1;
  options.cpu = reference.firstCpu();  // what moves, or waits for a page, stands still alone
  timer.start(options);
  HostThread host(bridge, 170);  // a second
  host.join();
  bridge.audioStopped();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  timer.stop();

  const auto events = bench.events();
  const Event started = test::firstOf(events, Event::Type::kAudioStarted);
  ASSERT_GE(started.tick, 0);
  EXPECT_EQ(test::count(events, Event::Type::kAudioStopped), 1);
  const std::int64_t offset = static_cast<std::int64_t>(started.value) - started.frame;
  const std::set<std::int64_t> missing = reported(events, offset);
  test::Trials trials(reference);
  for (const auto& [frame, sample] : host.sounded()) {
    const std::int64_t station_frame = frame - offset;
    const bool begun = station_frame >= started.frame;
    const bool sounds = begun && missing.count(frame) == 0;
    ASSERT_EQ(sample, sounds ? static_cast<float>(station_frame + 1) : 0.0F) << "at " << frame;
    if (begun) {
      trials.next();
      trials.judgeThat(sounds, host.windowOf(frame, config), "frame " + std::to_string(frame));
    }
  }
  EXPECT_GT(trials.onTime(), 30'000) << "it started late";
  trials.expectNineOfTen();
}

}  // namespace
}  // namespace ergotic::station
