// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "ergotic/station/station.hpp"
#include "support/station_doubles.hpp"

namespace ergotic::station {
namespace {

using test::Bench;

constexpr std::int64_t kRampTicks = 400;
constexpr std::int64_t kResumeTicks = 158;   // 50 ms at 3150 Hz
constexpr std::int64_t kMostCaughtUp = 158;  // 50 ms at 3150 Hz

/// The hand rests at 1 cm and is found at 2 cm after the stall.
double jump(std::int64_t exchange, int /*slice*/) {
  return exchange < kRampTicks ? 0.01 : 0.02;
}

std::vector<GestureTick> recorded(Bench& bench) {
  std::vector<GestureTick> ticks(4096);
  ticks.resize(bench.station->pollGestures(ticks.data(), ticks.size()));
  return ticks;
}

TEST(CatchUpTest, InterpolatesFromTheLastPositionToTheNewOneWithForceMuted) {
  Bench bench({}, jump);
  bench.command(Command::Type::kEngage);
  bench.run(kRampTicks);
  bench.station->catchUp(10, 3'000'000);
  const auto ticks = recorded(bench);
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
  bench.command(Command::Type::kEngage);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], -1.0);
  bench.station->catchUp(10, 3'000'000);
  EXPECT_EQ(bench.log.exchanges, kRampTicks + 1);
  EXPECT_EQ(bench.log.forces[0], 0.0);
}

TEST(CatchUpTest, RampsForceInAgain) {
  Bench bench({}, jump);
  bench.command(Command::Type::kEngage);
  bench.run(kRampTicks);
  bench.station->catchUp(10, 3'000'000);
  bench.run(2);
  EXPECT_LE(std::abs(bench.log.forces[0]), 0.04);
  bench.run(kResumeTicks);
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
  bench.command(Command::Type::kEngage);
  bench.run(kRampTicks);
  bench.station->catchUp(1000, 317'000'000);
  EXPECT_EQ(bench.station->nextTick(), kRampTicks + 1000);
  const auto events = bench.events();
  EXPECT_EQ(test::firstOf(events, Event::Type::kStall).index, kMostCaughtUp);
  const Event lost = test::firstOf(events, Event::Type::kTicksLost);
  EXPECT_EQ(lost.tick, kRampTicks);
  EXPECT_EQ(lost.index, 1000 - kMostCaughtUp);
  EXPECT_EQ(test::firstOf(events, Event::Type::kFault).index,
            static_cast<int>(FaultReason::kStall));

  // The oldest frames are the lost ones; the model made no samples meanwhile.
  const std::size_t before = kRampTicks * 14;
  ASSERT_EQ(frames.samples.size(), before + kMostCaughtUp * 14);
  EXPECT_EQ(frames.indices[before], (kRampTicks + 1000 - kMostCaughtUp) * 14);
  EXPECT_EQ(frames.samples[before], static_cast<float>(before));

  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0) << "latched";
}

TEST(CatchUpTest, RunsUpToMaxStallWithoutAFault) {
  Bench bench({}, jump);
  bench.run(10);
  bench.station->catchUp(kMostCaughtUp, 50'000'000);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kFault), 0);
  EXPECT_EQ(bench.station->nextTick(), 10 + kMostCaughtUp);
}

}  // namespace
}  // namespace ergotic::station
