// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/timer_source.hpp"

#include <array>
#include <map>
#include <thread>

#include "ergotic/rt/clock.hpp"
#include "ergotic/station/station.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/reference_threads.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::station {
namespace {

using test::Bench;
using test::kRampTicks;

constexpr double kStiffness = 100.0;
constexpr std::int64_t kResumeTicks = 18;  // 5 ms and a little
constexpr std::int64_t kMissedNs = 200'000;

double stampOf(std::int64_t n, int /*slice*/) {
  return 1e-6 * static_cast<double>(n % 20001 - 10000);
}

TimerOptions ordinary() {
  TimerOptions options;
  options.lock_memory = false;
  return options;
}

StationConfig longRecord() {
  StationConfig config = Bench::quickConfig();
  config.record_ring = 1U << 15U;
  // Stalls of the machine are no fault of what is tested.
  config.max_stall_s = 1.0;
  config.max_stalls = 1'000'000;
  config.safety.resume_ramp_s = 0.005;
  return config;
}

/// Two seconds of force under the timer, and the time of every exchange.
class LiveForce {
 public:
  explicit LiveForce(const test::ReferenceThreads& reference) {
    exchanges_.reserve(1U << 16U);
    bench_.driver->watch = [this](std::int64_t, const double* forces) {
      exchanges_.push_back({forces[0], rt::monotonicNs()});
    };
    TimerSource timer(*bench_.station, nullptr);
    bench_.command(Command::Type::kEngage);
    TimerOptions options = ordinary();
    options.priority = test::ReferenceThreads::kPriority - 1;
    // Next to one reference thread, which sees what it sees. Left to move, it is sent from one to
    // the other, and each processor stands still for less than is an excuse; and a thread that
    // waits for a page stands still alone.
    options.cpu = reference.firstCpu();
    options.lock_memory = true;
    timer.start(options);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    timer.stop();
    ticks_ = bench_.recorded();
    for (const Event& event : bench_.events()) {
      if (event.type == Event::Type::kStall) {
        stalls_.push_back(event);
      }
    }
  }

  /// That each position is that of its exchange, and that the next one sends the force of it. Where
  /// the station caught up, and so muted the force, the machine has to have stood still.
  void expectInStep(test::Trials& trials) {
    ASSERT_GT(ticks_.size(), 1000U);
    std::vector<bool> proves(ticks_.size() - 1);
    std::int64_t since_stall = 0;
    std::int64_t ramped = 0;
    std::size_t exchange = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < proves.size(); ++i) {
      const bool caught_up = isCaughtUp(i);
      since_stall = caught_up ? 0 : since_stall + 1;
      ramped += caught_up ? 0 : 1;  // the ramp stands still while force is muted
      first = ramped <= kRampTicks ? i + 1 : first;
      if (caught_up && positionOf(i) != stampOf(exchange)) {
        continue;  // it is interpolated, without an exchange of its own
      }
      ASSERT_EQ(positionOf(i), stampOf(exchange));
      if (caught_up) {
        noteStall(i, exchanges_[exchange].time_ns);
      }
      ++exchange;
      proves[i] = since_stall > kResumeTicks && !isCaughtUp(i + 1);
      if (proves[i] && i >= first) {
        ASSERT_EQ(exchanges_[exchange].sent, -kStiffness * positionOf(i)) << "tick " << i;
      }
    }
    EXPECT_EQ(exchanges_.back().sent, 0.0) << "the timer leaves the device at rest";
    for (std::size_t i = first; i < proves.size(); ++i) {
      trials.next();
      trials.judgeThat(proves[i], windowOf(i), "tick " + std::to_string(i));
    }
  }

 private:
  struct Exchange {
    double sent = 0.0;
    std::int64_t time_ns = 0;
  };

  static double stampOf(std::size_t exchange) {
    return station::stampOf(static_cast<std::int64_t>(exchange), 0);
  }
  bool isCaughtUp(std::size_t i) const { return (ticks_[i].flags & GestureTick::kCatchUp) != 0; }
  double positionOf(std::size_t i) const { return ticks_[i].position[0]; }

  /// That ended with the exchange of tick `i`, at this time.
  void noteStall(std::size_t i, std::int64_t end_ns) {
    const double seconds = stalls_.at(due_.size()).value;
    due_.emplace(i, end_ns - static_cast<std::int64_t>(1e9 * seconds));
  }
  /// Of the stall because of which tick `i` was without its force: from when the first tick was due
  /// that it missed until one is caught up, two periods later.
  test::Trials::Window windowOf(std::size_t i) const {
    const bool before = isCaughtUp(i) || isCaughtUp(i + 1);
    auto stall = before ? due_.lower_bound(i) : due_.upper_bound(i);
    if (!before && stall != due_.begin()) {
      --stall;
    }
    const double period_ns = 1e9 / bench_.station->config().rates.gesturalHz();
    const std::int64_t due_ns = stall == due_.end() ? 0 : stall->second;
    return {due_ns, due_ns + static_cast<std::int64_t>(2.0 * period_ns), kMissedNs};
  }

  Bench bench_{{}, station::stampOf, longRecord()};
  std::vector<Exchange> exchanges_;
  std::vector<GestureTick> ticks_;
  std::vector<Event> stalls_;
  std::map<std::size_t, std::int64_t> due_;  // by the tick of the exchange that ended a stall
};

TEST(TimerSourceTest, LiveForceOfATickGoesOutWithTheExchangeThatReadsTheNextPosition) {
  const test::ReferenceThreads reference(test::ReferenceThreads::Rank::kAboveAll,
                                         test::ReferenceThreads::kFinePauseNs);
  test::Trials trials(reference);
  LiveForce live(reference);
  live.expectInStep(trials);
  trials.expectNineOfTen();
}

TEST(TimerSourceTest, TickIndexKeepsUpWithTheClockThroughStalls) {
  Bench bench({}, stampOf, longRecord());
  bench.driver->flags_of = [](std::int64_t n) {
    if (n == 200) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return 0U;
  };
  TimerSource timer(*bench.station, nullptr);
  const auto begin = std::chrono::steady_clock::now();
  timer.start(ordinary());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  timer.stop();
  const std::chrono::duration<double> ran = std::chrono::steady_clock::now() - begin;
  // Every due tick was run or counted: the index cannot be ahead of the clock, and is behind it by
  // no more than what was not yet due when the timer was told to stop.
  EXPECT_LE(static_cast<double>(bench.station->nextTick()), ran.count() * 3150.0);
  const auto events = bench.events();
  EXPECT_GE(test::count(events, Event::Type::kStall), 1);
  std::int64_t caught_up = 0;
  std::int64_t lost = 0;
  for (const Event& event : events) {
    caught_up += event.type == Event::Type::kStall ? event.index : 0;
    lost += event.type == Event::Type::kTicksLost ? event.index : 0;
  }
  EXPECT_GE(caught_up, 60);  // 20 ms
  const std::vector<GestureTick> ticks = bench.recorded();
  EXPECT_EQ(static_cast<std::int64_t>(ticks.size()) + lost, bench.station->nextTick());
}

TEST(TimerSourceTest, CanBeStartedAgain) {
  Bench bench;
  TimerSource timer(*bench.station, nullptr);
  timer.start(ordinary());
  EXPECT_TRUE(timer.isRunning());
  EXPECT_THROW(timer.start(ordinary()), Exception);
  timer.stop();
  timer.stop();
  EXPECT_FALSE(timer.isRunning());
  const std::int64_t before = bench.station->nextTick();
  timer.start(ordinary());
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  timer.stop();
  EXPECT_GT(bench.station->nextTick(), before);
}

TEST(TimerSourceTest, TicksAllTheSameWhenTheSystemRefusesWhatWasAskedFor) {
  Bench bench;
  TimerSource timer(*bench.station, nullptr);
  TimerOptions options = ordinary();
  options.cpu = 1000;
  timer.start(options);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  timer.stop();
  ASSERT_FALSE(timer.warnings().empty());
  EXPECT_THAT(timer.warnings()[0], HasSubstr("cpu 1000"));
  EXPECT_GT(bench.station->nextTick(), 0);
}

TEST(TimerSourceTest, RefusesOptionsOutsideTheirRange) {
  Bench bench;
  TimerSource timer(*bench.station, nullptr);
  TimerOptions options;
  options.priority = 100;
  EXPECT_THROW(timer.start(options), Exception);
  options.priority = 50;
  options.cpu = -2;
  EXPECT_THROW(timer.start(options), Exception);
  EXPECT_FALSE(timer.isRunning());
}

constexpr std::int64_t kMaxCaughtUp = 158;  // 50 ms at 3150 Hz

/// The hand rests at 1 cm and is found at 2 cm after the stall.
double jump(std::int64_t exchange, int /*slice*/) {
  return exchange < kRampTicks ? 0.01 : 0.02;
}

TEST(CatchUpTest, InterpolatesFromTheLastPositionToTheNewOneWithForceMuted) {
  Bench bench({}, jump);
  bench.engage();
  bench.station->catchUp(10, 3'000'000);
  const auto ticks = bench.recorded();
  ASSERT_EQ(ticks.size(), 410U);
  for (std::size_t i = 1; i <= 10; ++i) {
    const GestureTick& tick = ticks[399 + i];
    EXPECT_EQ(tick.tick, static_cast<std::int64_t>(399 + i));
    EXPECT_NEAR(tick.position[0], 0.01 + 0.001 * static_cast<double>(i), 1e-15);
    EXPECT_EQ(tick.force[0], 0.0F);
    EXPECT_EQ(tick.flags, GestureTick::kCatchUp);
  }
  EXPECT_EQ(ticks.back().position[0], 0.02) << "the last one takes the sample as it is";
}

TEST(CatchUpTest, ExchangesOnceWithZeroForce) {
  Bench bench({}, jump);
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0);
  bench.station->catchUp(10, 3'000'000);
  EXPECT_EQ(bench.log.exchanges, kRampTicks + 1);
  EXPECT_EQ(bench.log.forces[0], 0.0);
}

/// Positions of each exchange.
double ramp(std::int64_t exchange, int /*slice*/) {
  return exchange < kRampTicks ? 0.01 : 0.01 + 0.0001 * static_cast<double>(exchange - kRampTicks);
}

TEST(CatchUpTest, RunsTheTicksOfASimulatedDeviceAsIfTheyHadBeenInTime) {
  Bench in_time({}, ramp);
  Bench late({}, ramp);
  late.driver->stepped_by_exchange = true;
  in_time.engage();
  late.engage();
  in_time.run(60);
  late.run(20);
  late.station->catchUp(10, 3'000'000);
  late.run(30);
  EXPECT_EQ(late.log.exchanges, in_time.log.exchanges);
  const auto expected = in_time.recorded();
  const auto ticks = late.recorded();
  ASSERT_EQ(ticks.size(), expected.size());
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    EXPECT_EQ(ticks[i].tick, expected[i].tick);
    EXPECT_EQ(ticks[i].position[0], expected[i].position[0]) << i;
    EXPECT_EQ(ticks[i].force[0], expected[i].force[0]) << i;
    EXPECT_EQ(ticks[i].flags, expected[i].flags) << i;
  }
  EXPECT_EQ(test::count(late.events(), Event::Type::kStall), 1);
}

TEST(CatchUpTest, LosesTheOldestTicksOfASimulatedDeviceBeyondMaxStall) {
  Bench bench({}, ramp);
  bench.driver->stepped_by_exchange = true;
  bench.engage();
  const std::int64_t exchanges = bench.log.exchanges;
  bench.station->catchUp(kMaxCaughtUp + 10, 53'000'000);
  EXPECT_EQ(bench.log.exchanges, exchanges + kMaxCaughtUp);
  EXPECT_EQ(bench.recorded().back().tick, kRampTicks + kMaxCaughtUp + 9);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kFault), 1);
}

TEST(CatchUpTest, AMoveBelongsToTheTickInWhoseTimeItWasAskedFor) {
  constexpr std::int64_t kTicks = 315;  // 100 ms
  Station station(longRecord(), tgr::makeVirtualDriver({}), test::makeSpring());
  const std::int64_t begin_ns = rt::monotonicNs();
  rt::sleepUntilNs(begin_ns + 50'000'000);
  tgr::HandMove move;
  move.grip = tgr::HandGrip::kKey;
  move.glide_s = 0.015;
  move.target_m = 0.01;
  EXPECT_TRUE(station.move(move));
  rt::sleepUntilNs(begin_ns + 100'000'000);
  station.catchUp(kTicks, 100'000'000);
  std::array<GestureTick, kTicks> ticks;
  ASSERT_EQ(station.pollGestures(ticks.data(), ticks.size()), ticks.size());
  EXPECT_NEAR(ticks[100].position[0], 0.0, 1e-4);
  EXPECT_NEAR(ticks[314].position[0], 0.01, 1e-3);
}

/// Latches the force within the third tick.
class StopInTheThird : public FramePort {
 public:
  explicit StopInTheThird(Station& station) : station_(station) {}
  void push(std::int64_t /*first*/, const float* /*frames*/, int /*nframes*/) noexcept override {
    if (++ticks_ == 3) {
      station_.makeSafe();
    }
  }
  bool pull(std::int64_t /*first*/, float* /*frames*/, int /*nframes*/) noexcept override {
    return false;
  }

 private:
  Station& station_;
  int ticks_ = 0;
};

TEST(CatchUpTest, AnEmergencyStopCountsBetweenTwoTicksOfASimulatedDevice) {
  Bench bench;
  bench.driver->stepped_by_exchange = true;
  bench.engage();
  std::vector<double> sent;
  sent.reserve(10);
  bench.driver->watch = [&](std::int64_t, const double* forces) { sent.push_back(forces[0]); };
  StopInTheThird stop(*bench.station);
  bench.station->setFramePort(&stop);
  bench.station->catchUp(10, 3'000'000);
  ASSERT_EQ(sent.size(), 10U);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(sent[i], i < 3 ? -1.0 : 0.0) << i;
  }
}

TEST(CatchUpTest, RampsForceInAgain) {
  Bench bench({}, jump);
  bench.engage();
  bench.station->catchUp(10, 3'000'000);
  bench.run(2);
  EXPECT_LE(std::abs(bench.log.forces[0]), 0.04);
  bench.run(158);  // 50 ms at 3150 Hz
  EXPECT_EQ(bench.log.forces[0], -2.0);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kPlaying), 1) << "the state does not flicker";
}

TEST(CatchUpTest, DoesNotEngageWhatWasNot) {
  Bench bench({}, jump);
  bench.run(kRampTicks);
  bench.station->catchUp(10, 3'000'000);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0);
}

TEST(CatchUpTest, PushesTheFramesOfEveryTick) {
  test::SpringInstrument::Setting setting;
  setting.count_frames = true;
  Bench bench(setting, jump);
  test::FrameLog frames(2);
  bench.station->setFramePort(&frames);
  bench.run(5);
  bench.station->catchUp(10, 3'000'000);
  bench.run(5);
  ASSERT_EQ(frames.samples.size(), 20U * 14U);
  for (std::size_t f = 0; f < frames.samples.size(); ++f) {
    ASSERT_EQ(frames.indices[f], static_cast<std::int64_t>(f));
    ASSERT_EQ(frames.samples[f], static_cast<float>(f));
  }
}

TEST(CatchUpTest, CountsAndTellsTheStall) {
  Bench bench({}, jump);
  bench.run(50);
  bench.station->catchUp(10, 3'000'000);
  bench.run(100);
  const auto events = bench.events();
  const Event stall = test::firstOf(events, Event::Type::kStall);
  EXPECT_EQ(stall.tick, 50);
  EXPECT_EQ(stall.index, 10);
  EXPECT_DOUBLE_EQ(stall.value, 3e-3);
  EXPECT_EQ(test::count(events, Event::Type::kFault), 0);
  const Snapshot* snapshot = bench.station->snapshot();
  ASSERT_NE(snapshot, nullptr);
  EXPECT_EQ(snapshot->counters.stalls, 1);
  EXPECT_EQ(snapshot->counters.catch_up_ticks, 10);
  EXPECT_EQ(snapshot->counters.lost_ticks, 0);
}

TEST(CatchUpTest, BoundsItsWorkByMaxStallAndKeepsFrameAndTickInStep) {
  test::SpringInstrument::Setting setting;
  setting.count_frames = true;
  Bench bench(setting, jump);
  test::FrameLog frames(2);
  bench.station->setFramePort(&frames);
  bench.engage();
  bench.station->catchUp(1000, 317'000'000);
  EXPECT_EQ(bench.station->nextTick(), kRampTicks + 1000);
  const auto events = bench.events();
  EXPECT_EQ(test::firstOf(events, Event::Type::kStall).index, kMaxCaughtUp);
  const Event lost = test::firstOf(events, Event::Type::kTicksLost);
  EXPECT_EQ(lost.tick, kRampTicks);
  EXPECT_EQ(lost.index, 1000 - kMaxCaughtUp);
  const Event fault = test::firstOf(events, Event::Type::kFault);
  EXPECT_EQ(fault.index, static_cast<int>(FaultReason::kStall));
  EXPECT_DOUBLE_EQ(fault.value, 0.317);
  EXPECT_EQ(fault.id, 0U) << "too long, not too often";

  // The oldest frames are the lost ones; the model made no samples meanwhile.
  const std::size_t before = kRampTicks * 14;
  ASSERT_EQ(frames.samples.size(), before + kMaxCaughtUp * 14);
  EXPECT_EQ(frames.indices[before], (kRampTicks + 1000 - kMaxCaughtUp) * 14);
  EXPECT_EQ(frames.samples[before], static_cast<float>(before));

  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0) << "latched";
}

TEST(CatchUpTest, RunsUpToMaxStallWithoutAFault) {
  Bench bench({}, jump);
  bench.run(10);
  bench.station->catchUp(kMaxCaughtUp, 50'000'000);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kFault), 0);
  EXPECT_EQ(bench.station->nextTick(), 10 + kMaxCaughtUp);
}

}  // namespace
}  // namespace ergotic::station
