// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/tick_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

namespace ergotic::station {
namespace {

using Kind = TickSchedule::Step::Kind;
constexpr double kPeriodNs = 1e9 * 14 / 44100;  // not a whole number of ns

TEST(TickScheduleTest, StaysOnAnExactGridWithoutAMaster) {
  TickSchedule schedule(kPeriodNs, 1'000'000'000'000'000);  // 11 days after boot
  for (int n = 0; n < 3150 * 60; ++n) {
    schedule.advance(1);
  }
  EXPECT_NEAR(static_cast<double>(schedule.dueNs() - 1'000'000'000'000'000), 60e9, 1.0);
}

TEST(TickScheduleTest, WaitsUntilDueThenRunsOneTick) {
  const TickSchedule schedule(kPeriodNs, 5'000'000);
  EXPECT_EQ(schedule.at(4'999'999).kind, Kind::kWait);
  const TickSchedule::Step step = schedule.at(5'000'000);
  EXPECT_EQ(step.kind, Kind::kRun);
  EXPECT_EQ(step.ticks, 1);
  EXPECT_EQ(step.late_ns, 0);
}

TEST(TickScheduleTest, RunsALateTickAsItIsUpToTwoPeriods) {
  const TickSchedule schedule(kPeriodNs, 0);
  const auto just_below = static_cast<std::int64_t>(2 * kPeriodNs) - 1;
  EXPECT_EQ(schedule.at(just_below).kind, Kind::kRun);
  EXPECT_EQ(schedule.at(just_below).late_ns, just_below);
}

TEST(TickScheduleTest, CatchesUpAllTicksThatAreDueAfterAStall) {
  TickSchedule schedule(kPeriodNs, 0);
  const auto now = static_cast<std::int64_t>(10.5 * kPeriodNs);
  const TickSchedule::Step step = schedule.at(now);
  EXPECT_EQ(step.kind, Kind::kCatchUp);
  EXPECT_EQ(step.ticks, 11);  // those due at 0, 1, ... 10 periods
  EXPECT_EQ(step.late_ns, now);
  schedule.advance(step.ticks);
  EXPECT_EQ(schedule.at(now).kind, Kind::kWait);
  EXPECT_NEAR(static_cast<double>(schedule.dueNs()), 11 * kPeriodNs, 1.0);
}

TEST(TickScheduleTest, CountsTheTicksOfAnHourLongStall) {
  const TickSchedule schedule(kPeriodNs, 0);
  EXPECT_EQ(schedule.at(3600 * std::int64_t{1'000'000'000}).ticks, 3600 * 3150 + 1);
}

TEST(TickScheduleTest, FollowsAMasterThatRunsALittleFast) {
  TickSchedule schedule(kPeriodNs, 0);
  const double master_period = kPeriodNs * (1.0 - 3e-4);
  for (int n = 1; n <= 20000; ++n) {
    schedule.advance(1);
    const auto master = static_cast<std::int64_t>(n * master_period);
    schedule.follow(master);
    ASSERT_LE(std::abs(schedule.dueNs() - master), 1);
  }
}

/// Whatever a master does, two ticks are never closer or farther than the slew allows.
TEST(TickScheduleTest, NeitherSkipsNorDoublesATickWhenAMasterComesJumpsOrGoes) {
  TickSchedule schedule(kPeriodNs, 0);
  std::int64_t last = 0;
  double least = 2 * kPeriodNs;
  double most = 0.0;
  for (int n = 1; n <= 6000; ++n) {
    schedule.advance(1);
    if (n > 1000 && n <= 3000) {
      schedule.follow(static_cast<std::int64_t>(n * kPeriodNs) + 3'000'000);  // 10 ticks away
    } else if (n > 3000 && n <= 5000) {
      schedule.follow(static_cast<std::int64_t>(n * kPeriodNs) - 1'500'000);
    }
    least = std::min(least, static_cast<double>(schedule.dueNs() - last));
    most = std::max(most, static_cast<double>(schedule.dueNs() - last));
    last = schedule.dueNs();
    if (n == 3000) {
      EXPECT_NEAR(static_cast<double>(last), n * kPeriodNs + 3'000'000, 2.0) << "it arrived";
    }
  }
  EXPECT_GE(least, kPeriodNs * (1.0 - TickSchedule::kMaxSlew) - 1.0);
  EXPECT_LE(most, kPeriodNs * (1.0 + TickSchedule::kMaxSlew) + 1.0);
}

}  // namespace
}  // namespace ergotic::station
