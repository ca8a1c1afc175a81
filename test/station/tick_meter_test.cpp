// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/tick_meter.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "support/alloc_count.hpp"
#include "support/station_doubles.hpp"

namespace ergotic::station {
namespace {

TEST(TickHistogramTest, PutsEveryDurationIntoTheBinThatHoldsIt) {
  for (std::int64_t ns = 0; ns < TickHistogram::kMostNs; ns += 1 + ns / 7) {
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
  EXPECT_EQ(histogram.maxNs(), TickHistogram::kMostNs);
  EXPECT_EQ(histogram.bins().back().high_ns, TickHistogram::kMostNs);
}

TEST(TickHistogramTest, AddsWithoutHeapCalls) {
  if (!test::AllocationScope::isAvailable()) {
    GTEST_SKIP() << "the sanitizer has its own heap";
  }
  TickHistogram histogram;
  const test::AllocationScope scope;
  for (std::int64_t n = 0; n < 1000; ++n) {
    histogram.add(n * n);
  }
  EXPECT_EQ(scope.calls(), 0);
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
