// SPDX-License-Identifier: BSD-3-Clause

#include <atomic>
#include <thread>

#include "comedi/comedi_rig.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

/// Exchanges in a thread of its own until it goes.
class Ticker {
 public:
  explicit Ticker(ComediRig& rig)
      : thread_([this, &rig] {
          while (!stop_) {
            flags_ = rig.exchange(1.0);
            ++ticks_;
            std::this_thread::yield();
          }
        }) {}
  ~Ticker() {
    stop_ = true;
    thread_.join();
  }
  /// Waits until `count` exchanges have begun and ended.
  void waitFor(int count) const {
    const int from = ticks_;
    while (ticks_ < from + count + 1) {
      std::this_thread::yield();
    }
  }
  std::uint32_t flags() const { return flags_; }

 private:
  std::atomic<int> ticks_{0};
  std::atomic<std::uint32_t> flags_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(ComediThreadsTest, OutputsAreSafeAfterMakeSafeWhileTicksGoOn) {
  constexpr int kRounds = 500;
  ComediRig rig;
  rig.driver().open(1000.0);
  const Ticker ticker(rig);
  int safe = 0;
  int armed = 0;
  for (int round = 0; round < kRounds; ++round) {
    rig.driver().makeSafe();
    ticker.waitFor(1);
    safe += comediStandinOutputVolts(0) == comediVolts(kMidCount) ? 1 : 0;
    rig.driver().rearm();
    ticker.waitFor(1);
    armed += comediStandinOutputVolts(0) != comediVolts(kMidCount) ? 1 : 0;
  }
  EXPECT_EQ(safe, kRounds);
  EXPECT_EQ(armed, kRounds) << "or the test sees nothing";
}

/// A tick may neither wait for a lock nor run a list of its own beside that of its exchange.
TEST(ComediThreadsTest, ATickThatMakesSafeLeavesItToItsNextExchange) {
  ComediRig rig;
  rig.driver().open(1000.0);
  rig.exchange(1.0);
  const std::int64_t lists = ComediRig::counters().lists;
  rig.driver().makeSafeInTick();
  EXPECT_EQ(ComediRig::counters().lists, lists);
  ComediRig::inject(ComediFault::kError);  // of lists that read
  EXPECT_NE(rig.exchange(1.0) & tgr::kMadeSafe, 0U);
  EXPECT_EQ(comediStandinOutputVolts(0), comediVolts(kMidCount)) << "by a list that only writes";
  EXPECT_EQ(ComediRig::counters().lists, lists + 2);
}

/// The list of a tick takes long, and the latch comes meanwhile: the same exchange undoes it.
TEST(ComediThreadsTest, AListThatOverlapsMakeSafeIsUndoneByItsOwnExchange) {
  ComediRig rig;
  rig.driver().open(1000.0);
  constexpr int kRounds = 50;
  int overtaken = 0;
  for (int round = 0; round < kRounds; ++round) {
    ComediRig::inject(ComediFault::kSlow, 0.001);
    std::uint32_t flags = 0;
    std::atomic<bool> begun{false};
    std::thread tick([&] {
      begun = true;
      flags = rig.exchange(1.0);
    });
    while (!begun) {
      std::this_thread::yield();
    }
    rig.driver().makeSafe();
    tick.join();
    ASSERT_EQ(comediStandinOutputVolts(0), comediVolts(kMidCount)) << round;
    overtaken += (flags & tgr::kMadeSafe) != 0 ? 1 : 0;
    rig.driver().rearm();
  }
  EXPECT_GT(overtaken, 0);
}

TEST(ComediThreadsTest, ComesBackWhileTicksAndMakeSafeGoOn) {
  constexpr int kRounds = 50;
  ComediRig rig;
  rig.driver().open(1000.0);
  const Ticker ticker(rig);
  std::atomic<bool> stop{false};
  std::thread watchdog([&] {
    while (!stop) {
      rig.driver().makeSafe();
      std::this_thread::yield();
      rig.driver().rearm();
    }
  });
  int lost = 0;
  int back = 0;
  for (int round = 0; round < kRounds; ++round) {
    ComediRig::inject(ComediFault::kUnplug);
    ticker.waitFor(1);
    lost += (ticker.flags() & tgr::kDeviceLost) != 0 ? 1 : 0;
    EXPECT_THROW(rig.driver().reconnect(), DeviceError);
    comediStandinPlugIn();
    rig.driver().reconnect();
    ticker.waitFor(1);
    back += (ticker.flags() & tgr::kDeviceLost) == 0 ? 1 : 0;
  }
  stop = true;
  watchdog.join();
  EXPECT_EQ(lost, kRounds);
  EXPECT_EQ(back, kRounds);
}

class ComediFaultsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    rig_.driver().open(1000.0);
    for (int n = 0; n < 5; ++n) {
      ASSERT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
    }
  }
  ComediRig rig_;
};

TEST_F(ComediFaultsTest, FlagsInputsThatAShortListLeftOut) {
  const Volts before = rig_.inputs;
  ComediRig::inject(ComediFault::kShort, 4);
  EXPECT_EQ(rig_.exchange(2.0), tgr::kMissingSample);
  EXPECT_NE(rig_.inputs[0], before[0]) << "was read";
  EXPECT_EQ(rig_.inputs[1], before[1]) << "was not";
  EXPECT_EQ(rig_.inputs[2], before[2]);
  EXPECT_NEAR(comediStandinOutputVolts(1), 2.0, kVoltsPerCount);
  EXPECT_EQ(rig_.exchange(2.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, FlagsOutputsThatAShortListLeftOut) {
  const Volts before = rig_.inputs;
  ComediRig::inject(ComediFault::kShort, 2);
  EXPECT_EQ(rig_.exchange(2.0), tgr::kMissingSample | tgr::kWriteFailed);
  EXPECT_EQ(rig_.inputs, before);
  EXPECT_NEAR(comediStandinOutputVolts(1), 1.0, kVoltsPerCount) << "slice 2";
}

TEST_F(ComediFaultsTest, FlagsAnErrorAsNothingReadAndNothingWritten) {
  const Volts before = rig_.inputs;
  ComediRig::inject(ComediFault::kError, 0.0, 3);
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(rig_.exchange(2.0), tgr::kMissingSample | tgr::kWriteFailed);
    EXPECT_EQ(rig_.inputs, before);
  }
  EXPECT_EQ(rig_.exchange(2.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, GivesTheRailOfAnInputAsItsHighestVolts) {
  ComediRig::inject(ComediFault::kRail);
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
  EXPECT_EQ(rig_.inputs[1], 10.0) << "slice 1 is at channel 0";
}

TEST_F(ComediFaultsTest, GivesTheVeryVoltsOfAStuckInput) {
  ComediRig::inject(ComediFault::kStuck, 0.0, 10);
  const Volts before = rig_.inputs;
  for (int n = 0; n < 10; ++n) {
    EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
    EXPECT_EQ(rig_.inputs[1], before[1]);
    EXPECT_NE(rig_.inputs[0], before[0]);
  }
}

TEST_F(ComediFaultsTest, BearsASlowList) {
  ComediRig::inject(ComediFault::kSlow, 0.02);
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, SaysThatAnUnpluggedBoardIsLostUntilReconnected) {
  ComediRig::inject(ComediFault::kUnplug);
  const Volts before = rig_.inputs;
  for (int n = 0; n < 5; ++n) {
    EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost);
    EXPECT_EQ(rig_.inputs, before);
  }
  EXPECT_THROW(rig_.driver().reconnect(), DeviceError) << "still away";
  EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost);
  comediStandinPlugIn();
  EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost) << "nobody asked for it";
  rig_.driver().reconnect();
  EXPECT_NEAR(comediStandinOutputVolts(0), 0.0, kVoltsPerCount) << "safe, until an exchange";
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, FindsABoardThatComesBackByItself) {
  ComediRig::inject(ComediFault::kUnplug, 1e-6);
  EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost);
  while (rig_.exchange(1.0) == tgr::kDeviceLost) {
    try {
      rig_.driver().reconnect();
    } catch (const DeviceError&) {  // not yet
    }
  }
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, MakesSafeALostBoardForWhenItComesBack) {
  ComediRig::inject(ComediFault::kUnplug);
  rig_.exchange(1.0);
  rig_.driver().makeSafe();
  comediStandinPlugIn();
  rig_.driver().reconnect();
  EXPECT_EQ(rig_.exchange(1.0), tgr::kMadeSafe);
  EXPECT_EQ(comediStandinOutputVolts(0), comediVolts(kMidCount));
  rig_.driver().rearm();
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, ReconnectLeavesABoardAloneThatIsWellOrClosed) {
  rig_.driver().reconnect();
  EXPECT_EQ(ComediRig::counters().opened, 1);
  EXPECT_NEAR(comediStandinOutputVolts(0), 1.0, kVoltsPerCount);
  rig_.driver().close();
  rig_.driver().reconnect();
  EXPECT_EQ(ComediRig::counters().opened, 1);
  EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost);
}

TEST_F(ComediFaultsTest, MakesSafeWithoutWaitingForATick) {
  EXPECT_NEAR(comediStandinOutputVolts(0), 1.0, kVoltsPerCount);
  rig_.driver().makeSafe();
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(comediStandinOutputVolts(channel), comediVolts(kMidCount));
  }
}

}  // namespace
}  // namespace ergotic::test
