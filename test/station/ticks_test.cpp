// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <thread>

#include "ergotic/station/tick_meter.hpp"
#include "ergotic/station/tick_schedule.hpp"
#include "support/realtime_scope.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

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

TEST(TickHistogramTest, PutsEveryDurationIntoTheBinThatHoldsIt) {
  for (std::int64_t ns = 0; ns < TickHistogram::kMaxNs; ns += 1 + ns / 7) {
    TickHistogram histogram;
    histogram.add(ns);
    const auto bins = histogram.bins();
    ASSERT_EQ(bins.size(), 1U);
    EXPECT_LE(bins[0].low_ns, ns);
    EXPECT_GE(bins[0].high_ns, ns);
    EXPECT_LE((bins[0].high_ns - bins[0].low_ns) * TickHistogram::kParts, bins[0].low_ns);
  }
}

TEST(TickHistogramTest, LeavesNoGapBetweenBins) {
  TickHistogram histogram;
  for (std::int64_t ns = 0; ns < 5000; ++ns) {
    histogram.add(ns);
  }
  std::int64_t next = 0;
  for (const TickHistogram::Bin& bin : histogram.bins()) {
    EXPECT_EQ(bin.low_ns, next);
    EXPECT_EQ(bin.count, std::min<std::int64_t>(bin.high_ns, 4999) - bin.low_ns + 1);
    next = bin.high_ns + 1;
  }
  EXPECT_EQ(histogram.count(), 5000);
}

TEST(TickHistogramTest, KnowsQuantilesToABinAndTheLongestExactly) {
  TickHistogram histogram;
  for (std::int64_t us = 1; us <= 10000; ++us) {
    histogram.add(1000 * us);
  }
  const auto isNear = [&](double part, std::int64_t ns) {
    const std::int64_t quantile = histogram.quantileNs(part);
    return quantile >= ns && quantile <= ns + ns / TickHistogram::kParts;
  };
  EXPECT_TRUE(isNear(0.0, 1'000));
  EXPECT_TRUE(isNear(0.5, 5'000'000));
  EXPECT_TRUE(isNear(0.99, 9'900'000));
  EXPECT_EQ(histogram.quantileNs(1.0), 10'000'000);
  EXPECT_EQ(histogram.maxNs(), 10'000'000);
}

TEST(TickHistogramTest, CountsWhatIsTooLongOrBelowZeroAtTheEnds) {
  TickHistogram histogram;
  EXPECT_EQ(histogram.quantileNs(0.5), 0) << "empty";
  histogram.add(-5);
  EXPECT_EQ(histogram.bins().front().high_ns, 0);
  histogram.add(INT64_MAX);
  EXPECT_EQ(histogram.maxNs(), TickHistogram::kMaxNs);
  EXPECT_EQ(histogram.bins().back().high_ns, TickHistogram::kMaxNs);
}

TEST(TickHistogramTest, AddsInRealTime) {
  TickHistogram histogram;
  test::expectRealtime([&] {
    for (std::int64_t n = 0; n < 1000; ++n) {
      histogram.add(n * n);
    }
  });
}

TEST(TickHistogramTest, LosesNothingThatIsAddedWhileAnotherThreadReads) {
  constexpr std::int64_t kCount = 200'000;
  TickHistogram histogram;
  std::atomic<bool> done{false};
  std::thread reader([&] {
    std::int64_t last = 0;
    while (!done) {
      const std::int64_t now = histogram.count();
      EXPECT_GE(now, last);
      last = now;
    }
  });
  for (std::int64_t n = 0; n < kCount; ++n) {
    histogram.add(n);
  }
  done = true;
  reader.join();
  EXPECT_EQ(histogram.count(), kCount);
}

TEST(TickMeterTest, CountsTheTicksThatAClockDrives) {
  test::Bench bench;
  TickMeter meter;
  bench.station->setMeter(&meter);
  bench.station->cycle({5000, false});
  bench.station->cycle({7000, false});
  bench.run(10);
  EXPECT_EQ(meter.wake_up.count(), 2);
  EXPECT_EQ(meter.wake_up.maxNs(), 7000);
  EXPECT_EQ(meter.exchange.count(), 2);
  EXPECT_EQ(meter.compute.count(), 2);
  EXPECT_EQ(meter.whole.count(), 2);
  EXPECT_GE(meter.whole.maxNs(), meter.compute.maxNs());
}

TEST(TickMeterTest, CountsAStallOnceWithItsLength) {
  test::Bench bench;
  TickMeter meter;
  bench.station->setMeter(&meter);
  bench.station->catchUp(10, 3'000'000);
  EXPECT_EQ(meter.wake_up.count(), 1);
  EXPECT_EQ(meter.wake_up.maxNs(), 3'000'000);
  EXPECT_EQ(meter.whole.count(), 0);
}

}  // namespace
}  // namespace ergotic::station
