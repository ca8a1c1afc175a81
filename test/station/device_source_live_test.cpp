// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/device_source.hpp"

#include <unistd.h>

#include <set>

#include <sys/wait.h>

#include "ergotic/rt/clock.hpp"
#include "ergotic/station/timer_source.hpp"
#include "support/audio_host.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

using test::Bench;
using test::SpringInstrument;

/// A device whose clock is the test.
class ClockedDriver final : public test::ScriptedDriver, public tgr::DeviceClock {
 public:
  using ScriptedDriver::ScriptedDriver;
  tgr::DeviceClock* clock() noexcept override { return this; }
  void start(tgr::TickTarget& to) override { target = &to; }
  void stop() noexcept override { target = nullptr; }
  double periodS() const noexcept override { return 0.001; }

  tgr::TickTarget* target = nullptr;
};

class DeviceSourceTest : public ::testing::Test {
 protected:
  explicit DeviceSourceTest(const SpringInstrument::Setting& setting = {}) {
    auto made = std::make_unique<ClockedDriver>(2, log_, [](std::int64_t, int) { return 0.01; });
    driver_ = made.get();
    station_ =
        std::make_unique<Station>(Bench::quickConfig(), std::move(made), test::makeSpring(setting));
  }
  void tick(int count) {
    for (int n = 0; n < count; ++n) {
      driver_->target->tick(0);
    }
  }
  int eventsOf(Event::Type type) {
    int count = 0;
    Event event;
    while (station_->poll(event)) {
      count += event.type == type ? 1 : 0;
    }
    return count;
  }

  test::DriverLog log_;
  ClockedDriver* driver_ = nullptr;
  std::unique_ptr<Station> station_;
};

TEST_F(DeviceSourceTest, NeedsADeviceWithAClock) {
  const Bench bench;
  EXPECT_THROW(DeviceSource(*bench.station, nullptr), Exception);
}

TEST_F(DeviceSourceTest, TicksWhenTheDeviceSays) {
  DeviceSource source(*station_, nullptr);
  EXPECT_FALSE(source.isRunning());
  source.start(false);
  EXPECT_TRUE(source.isRunning());
  EXPECT_THROW(source.start(false), Exception);
  tick(7);
  EXPECT_EQ(station_->nextTick(), 7);
  EXPECT_EQ(log_.exchanges, 7);
}

#ifndef ERGOTIC_SANITIZED  // which lets nobody lock memory
long lockedKb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmLck:") {
      long kb = 0;
      status >> kb;
      return kb;
    }
  }
  return -1;
}

/// In a process of its own, for memory stays locked. \return whether it says why it is not
bool locksMemory(TickSource& source, const std::function<void(bool)>& start) {
  const pid_t child = fork();
  if (child == 0) {
    start(false);
    const bool left = lockedKb() == 0;
    source.stop();
    start(true);
    const bool locked = lockedKb() > 0 || !source.warnings().empty();
    source.stop();
    _exit(left && locked ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST_F(DeviceSourceTest, LocksTheMemoryIfAskedTo) {
  DeviceSource source(*station_, nullptr);
  EXPECT_TRUE(locksMemory(source, [&](bool lock) { source.start(lock); }));
}

TEST(TimerSourceMemoryTest, IsLockedIfAskedTo) {
  Bench bench;
  TimerSource timer(*bench.station, nullptr);
  EXPECT_TRUE(locksMemory(timer, [&](bool lock) {
    TimerOptions options;
    options.priority = 0;
    options.lock_memory = lock;
    timer.start(options);
  }));
}

#endif

TEST_F(DeviceSourceTest, IsWhatTicksADeviceWithAClockAndATimerAnyOther) {
  TimerOptions options;
  options.lock_memory = false;
  options.priority = 0;
  Bench bench;
  const auto timer = startTicks(*bench.station, nullptr, options);
  EXPECT_NE(dynamic_cast<TimerSource*>(timer.get()), nullptr);
  EXPECT_TRUE(timer->isRunning());
  timer->stop();
  const auto device = startTicks(*station_, nullptr, options);
  EXPECT_NE(dynamic_cast<DeviceSource*>(device.get()), nullptr);
  tick(2);
  EXPECT_EQ(station_->nextTick(), 2);
}

TEST_F(DeviceSourceTest, CatchesUpWhatTheDeviceMissed) {
  DeviceSource source(*station_, nullptr);
  source.start(false);
  tick(3);
  driver_->target->missed(5, 1'600'000);
  EXPECT_EQ(station_->nextTick(), 8);
  EXPECT_EQ(log_.exchanges, 4) << "one exchange for all of them";
  EXPECT_EQ(eventsOf(Event::Type::kStall), 1);
  driver_->target->missed(1000, 320'000'000);
  EXPECT_EQ(station_->nextTick(), 1008);
  EXPECT_EQ(eventsOf(Event::Type::kFault), 1) << "longer than max_stall";
}

TEST_F(DeviceSourceTest, LeavesTheDeviceWithoutForce) {
  DeviceSource source(*station_, nullptr);
  source.start(false);
  Command engage;
  engage.type = Command::Type::kEngage;
  ASSERT_TRUE(station_->submit(engage));
  tick(500);
  ASSERT_LT(log_.forces[0], -0.5);
  source.stop();
  EXPECT_EQ(driver_->target, nullptr);
  EXPECT_EQ(log_.forces[0], 0.0);
  const std::int64_t exchanges = log_.exchanges;
  source.stop();
  EXPECT_EQ(log_.exchanges, exchanges) << "a source that does not run leaves the device alone";
  source.start(false);
  tick(100);
  EXPECT_EQ(log_.forces[0], 0.0) << "another engage is needed";
}

SpringInstrument::Setting frameCounter() {
  SpringInstrument::Setting setting;
  setting.count_frames = true;
  return setting;
}

/// Device and audio host are two clients of one server: both are called for each block.
class DeviceSourceSoundTest : public DeviceSourceTest {
 protected:
  static constexpr std::uint32_t kPeriod = 56;
  DeviceSourceSoundTest() : DeviceSourceTest(frameCounter()) {
    station_->setFramePort(&bridge_);
    host_.start(kPeriod, 5000, rt::monotonicNs());
    source_.start(false);
  }
  static AudioBridgeConfig bridgeConfig() {
    AudioBridgeConfig config;
    config.output_channels = 2;
    config.input_channels = 1;
    return config;
  }
  /// The block of the device, then that of the sound. \return host frame less station frame, of
  /// all frames that are not silent
  std::set<std::int64_t> play(int blocks) {
    std::set<std::int64_t> offsets;
    for (int n = 0; n < blocks; ++n) {
      for (std::uint32_t frame = 0; frame < kPeriod; frame += 14) {
        const std::int64_t due_ns = host_.timeOf(host_.nextFrame() + frame);
        driver_->target->tick(rt::monotonicNs() - due_ns);
      }
      const std::int64_t first = host_.nextFrame();
      const std::vector<float> out = host_.period();
      for (std::uint32_t i = 0; i < kPeriod; ++i) {
        if (out[i] != 0.0F) {
          offsets.insert(first + i - static_cast<std::int64_t>(out[i]));
        }
      }
    }
    return offsets;
  }

  AudioBridge bridge_{bridgeConfig()};
  test::AudioHost host_{bridge_, 2, 1, 44100.0};
  DeviceSource source_{*station_, &bridge_};
};

TEST_F(DeviceSourceSoundTest, KeepsFramesAtTheirPlacesThroughBlocksThatAreLeftOut) {
  const std::set<std::int64_t> before = play(60);
  ASSERT_EQ(before.size(), 1U);
  constexpr int kLostBlocks = 3;
  host_.skip(kLostBlocks * kPeriod);
  driver_->target->missed(kLostBlocks * kPeriod / 14, 3'800'000);
  EXPECT_EQ(play(60), before);
  EXPECT_EQ(bridge_.status().underruns, 0);
}

TEST_F(DeviceSourceSoundTest, IsSilentOnceStopped) {
  ASSERT_FALSE(play(60).empty());
  source_.stop();
  host_.period();
  EXPECT_EQ(host_.period(), std::vector<float>(kPeriod, 0.0F));
}

}  // namespace
}  // namespace ergotic::station
