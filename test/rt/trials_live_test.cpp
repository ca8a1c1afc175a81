// SPDX-License-Identifier: BSD-3-Clause
#include "support/trials.hpp"

#include <thread>

#include <gtest/gtest-spi.h>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "support/reference_threads.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

using Verdict = Trials::Verdict;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kLimit = 10 * kMs;

/// One stall, as reference threads would tell of it.
struct Stall {
  std::int64_t from_ns;
  std::int64_t to_ns;
  std::int64_t operator()(std::int64_t from, std::int64_t to) const {
    return std::max(std::min(to, to_ns) - std::max(from, from_ns), std::int64_t{0});
  }
};
constexpr Stall kNone{0, 0};

/// A try from 0 on.
Verdict judged(const Stall& stall, std::int64_t happened_ns) {
  Trials trials(stall);
  trials.next();
  return trials.judge({0, kLimit}, happened_ns);
}

TEST(TrialsTest, WhatIsInTimeNeedsNoExcuse) {
  EXPECT_EQ(judged(kNone, kLimit), Verdict::kOnTime);
  EXPECT_EQ(judged({1 * kMs, 9 * kMs}, kLimit), Verdict::kOnTime);
}

TEST(TrialsTest, WhatIsLateWithoutAStallFailsAtOnce) {
  EXPECT_NONFATAL_FAILURE(judged(kNone, kLimit + 1), "limit 10 ms");
  EXPECT_NONFATAL_FAILURE(judged(kNone, Trials::kNever), "was not so");
  EXPECT_NONFATAL_FAILURE(
      {
        Trials trials(kNone);
        trials.goOn();
        trials.judge({0, kLimit}, 2 * kLimit);
        EXPECT_FALSE(trials.goOn()) << "no further try";
      },
      "it came after 20");
}

TEST(TrialsTest, AStallUntilTheLimitExcuses) {
  EXPECT_EQ(judged({4 * kMs, 6 * kMs}, 12 * kMs), Verdict::kExcused);
  EXPECT_EQ(judged({-5 * kMs, 2 * kMs}, 12 * kMs), Verdict::kExcused) << "went on at the start";
  EXPECT_EQ(judged({8 * kMs, 90 * kMs}, 91 * kMs), Verdict::kExcused) << "goes on at the limit";
}

TEST(TrialsTest, AStallAfterTheLimitOrBeforeTheStartOrOneThatIsTooShortDoesNot) {
  EXPECT_NONFATAL_FAILURE(judged({kLimit, 90 * kMs}, 91 * kMs), "no more than 0 ms");
  EXPECT_NONFATAL_FAILURE(judged({kLimit + 5 * kMs, 90 * kMs}, 91 * kMs), "no more than 0 ms");
  EXPECT_NONFATAL_FAILURE(judged({-90 * kMs, 0}, 12 * kMs), "no more than 0 ms");
  EXPECT_NONFATAL_FAILURE(judged({4 * kMs, 6 * kMs - 1}, 12 * kMs), "no more than 1.99");
}

/// \return on time, of five tries of which the first so many are excused
int onTimeOfFive(int excused) {
  Trials trials(Stall{0, kLimit}, 5);
  for (int n = 0; trials.goOn(); ++n) {
    trials.judge({0, kLimit}, n < excused ? 2 * kLimit : kLimit);
  }
  EXPECT_EQ(trials.tries(), 5);
  return trials.onTime();
}

TEST(TrialsTest, ThreeOfFiveHaveToBeOnTime) {
  EXPECT_EQ(onTimeOfFive(0), 5);
  EXPECT_EQ(onTimeOfFive(2), 3);
  EXPECT_NONFATAL_FAILURE(EXPECT_EQ(onTimeOfFive(3), 2), "too often");
  EXPECT_NONFATAL_FAILURE(EXPECT_EQ(onTimeOfFive(5), 0), "too often");
}

/// Of twenty tries so many are excused.
void expectNineOfTen(int excused) {
  Trials trials(Stall{0, kLimit});
  for (int n = 0; n < 20; ++n) {
    trials.next();
    trials.judgeThat(n >= excused, {0, kLimit});
  }
  trials.expectNineOfTen();
}

TEST(TrialsTest, NoMoreThanATenthOfManyIsExcused) {
  expectNineOfTen(2);
  EXPECT_NONFATAL_FAILURE(expectNineOfTen(3), "too often");
}

TEST(TrialsTest, TheWorstThatIsJudgedInATryCounts) {
  Trials trials(Stall{0, kLimit});
  trials.next();
  trials.judge({0, kLimit}, 2 * kLimit);
  trials.judgeThat(true, {0, kLimit});
  trials.next();
  trials.judgeThat(true, {0, kLimit});
  trials.next();
  EXPECT_EQ(trials.excused(), 1);
  EXPECT_EQ(trials.onTime(), 1);
}

TEST(ReferenceThreadsTest, SeeAProcessorThatStandsStillAndWhen) {
  const ReferenceThreads reference;
  rt::sleepUntilNs(rt::monotonicNs() + 10 * kMs);  // they run
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  bool permitted = false;
  std::thread([&] {
    permitted = rt::makeRealtime(95).ok;
    from_ns = rt::monotonicNs();
    while (permitted && (to_ns = rt::monotonicNs()) < from_ns + 8 * kMs) {
    }
  }).join();
  if (!permitted) {
    GTEST_SKIP() << "nothing may outrank them here";
  }
  EXPECT_GE(reference.longestStallNs(from_ns, to_ns), 7 * kMs);
  EXPECT_LE(reference.longestStallNs(from_ns, from_ns + 3 * kMs), 3 * kMs) << "in between";
  EXPECT_EQ(reference.longestStallNs(from_ns - 4 * kMs, from_ns - 8 * kMs), 0);
}

}  // namespace
}  // namespace ergotic::test
