// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "comedi/comedi_rig.hpp"
#include "ergotic/exception.hpp"

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

}  // namespace
}  // namespace ergotic::test
