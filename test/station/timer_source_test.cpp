// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/timer_source.hpp"

#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "support/station_doubles.hpp"

namespace ergotic::station {
namespace {

using test::Bench;

constexpr double kStiffness = 100.0;
constexpr std::int64_t kRampTicks = 400;
constexpr std::int64_t kResumeTicks = 18;  // 5 ms and a little

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
  config.safety.resume_ramp_s = 0.005;
  return config;
}

TEST(TimerSourceTest, LiveForceOfATickGoesOutWithTheExchangeThatReadsTheNextPosition) {
  Bench bench({}, stampOf, longRecord());
  std::vector<double> sent;  // [exchange]
  sent.reserve(1U << 16U);
  bench.driver->watch = [&](std::int64_t, const double* forces) { sent.push_back(forces[0]); };
  TimerSource timer(*bench.station, nullptr);
  bench.command(Command::Type::kEngage);
  timer.start(ordinary());
  std::this_thread::sleep_for(std::chrono::seconds(2));
  timer.stop();

  std::vector<GestureTick> ticks(1U << 15U);
  ticks.resize(bench.station->pollGestures(ticks.data(), ticks.size()));
  ASSERT_GT(ticks.size(), 1000U);
  std::size_t exchange = 0;
  std::int64_t since_stall = 0;
  std::int64_t ramped = 0;
  std::int64_t proved = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const bool caught_up = (ticks[i].flags & GestureTick::kCatchUp) != 0;
    const bool last_of_stall =
        caught_up && ticks[i].position[0] == stampOf(static_cast<std::int64_t>(exchange), 0);
    since_stall = caught_up ? 0 : since_stall + 1;
    ramped += caught_up ? 0 : 1;  // the ramp stands still while force is muted
    if (caught_up && !last_of_stall) {
      continue;  // an interpolated tick: no exchange of its own
    }
    ASSERT_EQ(ticks[i].position[0], stampOf(static_cast<std::int64_t>(exchange), 0));
    ++exchange;
    ASSERT_LT(exchange, sent.size());
    if (i + 1 < ticks.size() && ramped > kRampTicks && since_stall > kResumeTicks &&
        (ticks[i + 1].flags & GestureTick::kCatchUp) == 0) {
      ASSERT_EQ(sent[exchange], -kStiffness * ticks[i].position[0]) << "tick " << ticks[i].tick;
      ++proved;
    }
  }
  EXPECT_GT(proved, 500) << "the machine stalls all the time";
  RecordProperty("ticks_proved", static_cast<int>(proved));
  EXPECT_EQ(sent.back(), 0.0) << "the timer leaves the device at rest";
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
  std::vector<GestureTick> ticks(1U << 15U);
  ticks.resize(bench.station->pollGestures(ticks.data(), ticks.size()));
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
  EXPECT_NE(timer.warnings()[0].find("cpu 1000"), std::string::npos);
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

}  // namespace
}  // namespace ergotic::station
