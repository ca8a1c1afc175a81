// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/watchdog.hpp"

#include <atomic>
#include <thread>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "ergotic/tgr/safety/tick_watch.hpp"
#include "support/reference_threads.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::tgr {
namespace {

const WatchdogOptions kQuick{0.004, 0};
constexpr std::int64_t kPeriodNs = 4'000'000;

void pause(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

class WatchdogThreadsTest : public ::testing::Test {
 protected:
  void tickFor(int ms) {
    const std::int64_t end_ns = rt::monotonicNs() + ms * std::int64_t{1'000'000};
    while (rt::monotonicNs() < end_ns) {
      ++ticks_;
      std::this_thread::yield();
    }
  }
  /// As a station does: before other processes.
  void tickInTime(int ms) {
    rt::makeRealtime(test::ReferenceThreads::kPriority - 1);
    std::int64_t due_ns = rt::monotonicNs();
    for (int tick = 0; tick < 2 * ms; ++tick) {
      ++ticks_;
      rt::sleepUntilNs(due_ns += 500'000);
    }
  }
  /// Ticks and stops until it has acted `count` times.
  void stopUntilBites(int count) {
    while (dog_.reading().bites < count) {
      tickFor(5);  // it looks every millisecond
      pause(10);
    }
  }

  std::atomic<std::int64_t> ticks_{0};
  std::atomic<int> calls_{0};
  std::atomic<std::int64_t> told_ns_{0};
  Watchdog dog_{ticks_, [this](std::int64_t silence_ns) {
                  told_ns_ = silence_ns;
                  ++calls_;
                }};
};

TEST_F(WatchdogThreadsTest, ActsOncePerStopAndTellsHowLong) {
  constexpr int kRounds = 20;
  dog_.start(kQuick);
  for (int round = 1; round <= kRounds; ++round) {
    dog_.arm();
    stopUntilBites(round);
    EXPECT_FALSE(dog_.isArmed());
    EXPECT_GE(told_ns_, kPeriodNs);
    EXPECT_EQ(dog_.reading().silence_ns, told_ns_);
    EXPECT_EQ(dog_.reading().bites, round);
  }
  pause(20);
  dog_.stop();
  EXPECT_EQ(calls_, kRounds);
  EXPECT_EQ(dog_.reading().bites, kRounds);
}

TEST_F(WatchdogThreadsTest, StaysQuietWhileTicksGoOn) {
  const test::ReferenceThreads reference;
  test::Trials trials(reference);
  dog_.start(kQuick);
  for (std::int64_t bites = 0; trials.goOn(); bites = dog_.reading().bites) {
    dog_.arm();
    const std::int64_t from_ns = rt::monotonicNs();
    std::thread([this] { tickInTime(300); }).join();
    dog_.disarm();
    trials.judgeThat(dog_.reading().bites == bites, {from_ns, rt::monotonicNs()}, "quiet");
  }
}

TEST_F(WatchdogThreadsTest, StaysQuietUnlessArmed) {
  dog_.start(kQuick);
  tickFor(10);
  pause(30);
  dog_.arm();
  pause(30);  // no tick since
  EXPECT_EQ(dog_.reading().bites, 0);
  dog_.disarm();
  tickFor(10);
  pause(30);
  dog_.stop();
  EXPECT_EQ(calls_, 0);
}

TEST_F(WatchdogThreadsTest, MayBeArmedFromItsOwnActAndFromOtherThreads) {
  std::atomic<int> acts{0};
  Watchdog* self = nullptr;
  Watchdog dog(ticks_, [&](std::int64_t) {
    ++acts;
    self->arm();
  });
  self = &dog;
  dog.start(kQuick);
  dog.arm();
  std::atomic<bool> done{false};
  std::thread operators([&] {
    while (!done) {
      dog.arm();
      std::this_thread::yield();
    }
  });
  while (acts < 5) {
    ++ticks_;
    pause(10);
  }
  done = true;
  operators.join();
  dog.stop();
  EXPECT_EQ(acts, dog.reading().bites);
}

TEST_F(WatchdogThreadsTest, StartsAndStopsAgain) {
  for (int i = 1; i <= 3; ++i) {
    dog_.start(kQuick);
    EXPECT_TRUE(dog_.isRunning());
    EXPECT_FALSE(dog_.isArmed());
    dog_.arm();
    stopUntilBites(i);
    dog_.stop();
    dog_.stop();
    EXPECT_FALSE(dog_.isRunning());
  }
}

TEST_F(WatchdogThreadsTest, SaysWhatItCouldNotGet) {
  dog_.start({0.02, 80});
  // Either the system gives the priority or it says why not.
  EXPECT_TRUE(dog_.isRunning());
  EXPECT_TRUE(dog_.warning().empty() || dog_.warning().find("priority") != std::string::npos)
      << dog_.warning();
}

TEST_F(WatchdogThreadsTest, RefusesOptionsOutsideTheirRange) {
  EXPECT_THROW(dog_.start({0.003, 0}), Exception);
  EXPECT_THROW(dog_.start({1.1, 0}), Exception);
  EXPECT_THROW(dog_.start({0.02, -1}), Exception);
  EXPECT_THROW(dog_.start({0.02, 100}), Exception);
  dog_.start(kQuick);
  EXPECT_THROW(dog_.start(kQuick), Exception);
}

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
