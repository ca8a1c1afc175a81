// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/tick_watch.hpp"

#include <gtest/gtest.h>

namespace ergotic::tgr {
namespace {

constexpr std::int64_t kMs = 1'000'000;

class TickWatchTest : public ::testing::Test {
 protected:
  /// A look after `ms`; `ticks` more have run.
  bool look(std::int64_t ms, std::int64_t ticks) {
    now_ns_ += ms * kMs;
    ticks_ += ticks;
    return watch_.look(now_ns_, ticks_);
  }
  /// Watching, with a tick at the last look.
  void begin() {
    look(0, 0);
    watch_.arm();
    look(5, 1);
  }

  TickWatch watch_{20 * kMs, 5 * kMs};
  std::int64_t now_ns_ = 1'000'000 * kMs;
  std::int64_t ticks_ = 12;
};

TEST_F(TickWatchTest, ActsOnceAfterAPeriodOfSilence) {
  begin();
  EXPECT_FALSE(look(5, 0));
  EXPECT_FALSE(look(5, 0));
  EXPECT_FALSE(look(5, 0));
  EXPECT_TRUE(look(5, 0));
  EXPECT_EQ(watch_.silenceNs(), 20 * kMs);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(look(5, 0));
  }
}

TEST_F(TickWatchTest, StaysQuietWhileTicksGoOnHoweverSlowly) {
  begin();
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(look(5, i % 4 == 3 ? 1 : 0));
  }
}

TEST_F(TickWatchTest, WaitsForTheFirstTickAfterItIsArmed) {
  look(0, 0);
  watch_.arm();
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(look(5, 0));
  }
  look(5, 1);
  int acted = 0;
  for (int i = 0; i < 100; ++i) {
    acted += look(5, 0) ? 1 : 0;
  }
  EXPECT_EQ(acted, 1);
}

TEST_F(TickWatchTest, ActsAgainOnlyWhenArmedAgainAndTicksWentOn) {
  begin();
  for (int i = 0; i < 4; ++i) {
    look(5, 0);
  }
  EXPECT_FALSE(watch_.isArmed());
  look(5, 1);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(look(5, 0)) << "nobody armed it";
  }
  watch_.arm();
  look(5, 1);
  int acted = 0;
  for (int i = 0; i < 100; ++i) {
    acted += look(5, 0) ? 1 : 0;
  }
  EXPECT_EQ(acted, 1);
}

TEST_F(TickWatchTest, DoesNotActWhileDisarmed) {
  begin();
  watch_.disarm();
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(look(5, 0));
  }
}

TEST_F(TickWatchTest, TellsAStallOfTheWholeMachineApart) {
  begin();
  EXPECT_FALSE(look(2000, 0)) << "it stood still itself";
  EXPECT_EQ(watch_.machineStalls(), 1);
  EXPECT_EQ(watch_.longestStallNs(), 1995 * kMs);
  EXPECT_FALSE(look(5, 6300)) << "ticks went on when the machine did";
}

TEST_F(TickWatchTest, ActsWithinAPeriodIfTicksDoNotReturnAfterAStall) {
  begin();
  EXPECT_FALSE(look(2000, 0));
  EXPECT_FALSE(look(5, 0));
  EXPECT_FALSE(look(5, 0));
  EXPECT_TRUE(look(5, 0));
  EXPECT_EQ(watch_.silenceNs(), 2015 * kMs);
}

TEST_F(TickWatchTest, ActsAlsoIfEveryLookIsLate) {
  begin();
  EXPECT_FALSE(look(19, 0));
  EXPECT_FALSE(look(19, 0));
  EXPECT_FALSE(look(19, 0));
  EXPECT_TRUE(look(19, 0));
  EXPECT_EQ(watch_.machineStalls(), 0);
}

}  // namespace
}  // namespace ergotic::tgr
