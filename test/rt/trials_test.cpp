// SPDX-License-Identifier: BSD-3-Clause
#include "support/trials.hpp"

#include <thread>

#include <gtest/gtest-spi.h>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "support/reference_threads.hpp"
#include "support/scratch_file.hpp"
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
  Trials trials(stall, "");
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
        Trials trials(kNone, "");
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

/// \return on time, of tries of which the first so many were excused
int onTimeAfter(int excused) {
  Trials trials(Stall{0, kLimit}, "");
  for (int n = 0; trials.goOn(); ++n) {
    trials.judge({0, kLimit}, n < excused ? 2 * kLimit : kLimit);
  }
  return trials.onTime();
}

TEST(TrialsTest, WhatIsExcusedIsTriedAgainUntilThreeWereOnTime) {
  EXPECT_EQ(onTimeAfter(0), 3);
  EXPECT_EQ(onTimeAfter(1), 3);
  EXPECT_EQ(onTimeAfter(9), 3);
  EXPECT_NONFATAL_FAILURE(EXPECT_EQ(onTimeAfter(10), 2), "10 of 12 tries excused");
  EXPECT_NONFATAL_FAILURE(EXPECT_EQ(onTimeAfter(12), 0), "12 of 12 tries excused");
}

TEST(TrialsTest, AsManyAsAreWantedHaveToBeOnTime) {
  constexpr int kStops = 28;
  Trials trials(Stall{0, kLimit}, "", kStops);
  int tries = 0;
  for (; trials.goOn(); ++tries) {
    trials.judgeThat(tries % 2 == 1, {0, kLimit});
  }
  EXPECT_EQ(trials.onTime(), kStops);
  EXPECT_EQ(tries, 2 * kStops);
}

TEST(TrialsTest, TheWorstThatIsJudgedInATryCounts) {
  Trials trials(Stall{0, kLimit}, "");
  trials.next();
  trials.judge({0, kLimit}, 2 * kLimit);
  trials.judgeThat(true, {0, kLimit});
  trials.next();
  trials.judgeThat(true, {0, kLimit});
  trials.next();
  EXPECT_EQ(trials.excused(), 1);
  EXPECT_EQ(trials.onTime(), 1);
}

/// Of so many tries the first are excused.
void expectNineOfTen(int excused, int tries) {
  Trials trials(Stall{0, kLimit}, "");
  for (int n = 0; n < tries; ++n) {
    trials.next();
    trials.judgeThat(n >= excused, {0, kLimit});
  }
  trials.expectNineOfTen();
}

TEST(TrialsTest, NoMoreThanATenthOfManyIsExcused) {
  expectNineOfTen(2, 20);
  EXPECT_NONFATAL_FAILURE(expectNineOfTen(3, 20), "too often");
}

TEST(TrialsTest, NotesWhatCameOfItForTheRun) {
  const ScratchFile notes("before\t3\t0\n");
  {
    Trials trials(Stall{0, kLimit}, notes.path());
    for (int n = 0; trials.goOn(); ++n) {
      trials.judgeThat(n != 1, {0, kLimit});
    }
  }
  EXPECT_EQ(notes.text(), "before\t3\t0\nTrialsTest.NotesWhatCameOfItForTheRun\t4\t1\n");
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
