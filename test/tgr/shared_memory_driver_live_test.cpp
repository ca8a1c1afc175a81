// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/shared_memory_driver.hpp"

#include <unistd.h>

#include <csignal>

#include <sys/wait.h>

#include "ergotic/rt/clock.hpp"
#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"

namespace ergotic::tgr {
namespace {

using test::ThreeSlices;

constexpr int kWatchdogSteps = 10;  // of 1 ms

class SharedMemoryDriverTest : public ::testing::Test {
 protected:
  std::uint32_t exchange(double force) {
    const ThreeSlices forces{force, 0.0, 0.0};
    return rig_.driver().exchange(forces.data(), x_.data());
  }
  /// The force that slice 0 feels after the device's next step.
  double felt() {
    rig_.elapse();
    ForceRecord record;
    while (rig_.device().pollForce(record)) {
      felt_ = record.slice == 0 ? record.force_n : felt_;
    }
    return felt_;
  }
  void play(double force) {
    rig_.driver().open(1000.0);
    exchange(force);
    ASSERT_EQ(felt(), force);
  }

  test::SharedMemoryRig rig_;
  ThreeSlices x_{};
  double felt_ = 0.0;
};

TEST_F(SharedMemoryDriverTest, ForceReachesTheDeviceWithItsNextStep) {
  rig_.driver().open(1000.0);
  EXPECT_EQ(exchange(7.5), kExchangeOk);
  EXPECT_EQ(felt(), 7.5);
  exchange(-300.0);
  EXPECT_EQ(felt(), -200.0) << "saturated";
}

TEST_F(SharedMemoryDriverTest, MovesAsADeviceInsideTheDriverDoes) {
  test::InProcessRig inside;
  inside.driver().open(1000.0);
  rig_.driver().open(1000.0);
  for (int n = 0; n < 300; ++n) {
    const double force = 5.0 * std::sin(0.05 * n);
    exchange(force);
    rig_.elapse();
    const ThreeSlices forces{force, 0.0, 0.0};
    ThreeSlices x{};
    inside.driver().exchange(forces.data(), x.data());
    ASSERT_EQ(x_, x) << "tick " << n;
  }
}

TEST_F(SharedMemoryDriverTest, WatchdogLetsGoOfNothingWhileExchangesCome) {
  play(15.0);
  for (int n = 0; n < 500; ++n) {
    if (n % kWatchdogSteps == 0) {
      EXPECT_EQ(exchange(15.0), kExchangeOk);
    }
    ASSERT_EQ(felt(), 15.0);
  }
}

TEST_F(SharedMemoryDriverTest, WatchdogLatchesUntilAnExchangeAndARearm) {
  play(15.0);
  for (int n = 0; n <= kWatchdogSteps; ++n) {
    rig_.elapse();
  }
  for (int n = 0; n < 5; ++n) {
    EXPECT_EQ(exchange(15.0), kMadeSafe);
    EXPECT_EQ(felt(), 0.0) << "an exchange alone is not enough";
  }
  for (int n = 0; n < 2 * kWatchdogSteps; ++n) {
    rig_.elapse();
  }
  rig_.driver().rearm();
  EXPECT_EQ(felt(), 0.0) << "a rearm alone is not enough";
  EXPECT_EQ(exchange(15.0), kExchangeOk);
  EXPECT_EQ(felt(), 15.0);
}

TEST_F(SharedMemoryDriverTest, RearmDoesNotBringBackTheForceFromBeforeTheSilence) {
  play(15.0);
  for (int n = 0; n <= kWatchdogSteps; ++n) {
    rig_.elapse();
  }
  rig_.driver().rearm();
  EXPECT_EQ(felt(), 0.0);
}

TEST_F(SharedMemoryDriverTest, TellsTheDeviceOfAMakeSafeFromBeforeOpen) {
  rig_.driver().makeSafe();
  rig_.driver().open(1000.0);
  EXPECT_NE(SharedSegment::attach(rig_.name())->safe.load(), 0U);
}

TEST_F(SharedMemoryDriverTest, ADeviceThatIsSilentForASecondIsLost) {
  play(15.0);
  const SharedSegment segment = SharedSegment::attach(rig_.name());
  const auto metAfter = [&](std::int64_t silence_ns) {
    segment->heartbeat_ns = rt::monotonicNs() - silence_ns;
    return exchange(15.0) & (kDeviceLost | kMissingSample);
  };
  EXPECT_EQ(metAfter(0), 0U);
  EXPECT_EQ(metAfter(900'000'000), kMissingSample);
  EXPECT_EQ(metAfter(1'000'000'001), kDeviceLost);
}

TEST_F(SharedMemoryDriverTest, MakeSafeNeedsNoExchange) {
  play(15.0);
  rig_.driver().makeSafe();
  EXPECT_EQ(felt(), 0.0);
}

TEST_F(SharedMemoryDriverTest, CloseTakesTheForceOff) {
  play(15.0);
  rig_.driver().close();
  EXPECT_EQ(felt(), 0.0);
}

TEST_F(SharedMemoryDriverTest, OpensSlowlyWithoutWakingTheWatchdog) {
  rig_.driver().open(1000.0);
  for (int n = 0; n < 5 * kWatchdogSteps; ++n) {
    rig_.elapse();
  }
  EXPECT_EQ(exchange(3.0), kExchangeOk);
  EXPECT_EQ(felt(), 3.0);
}

TEST_F(SharedMemoryDriverTest, FlagsADeviceThatIsSlowAndOneThatIsLost) {
  rig_.driver().open(1000.0);
  rig_.setNow(rt::monotonicNs() - SharedMemoryDriver::kMissingNs - test::SharedMemoryRig::kStepNs);
  rig_.elapse();
  EXPECT_NE(exchange(0.0) & (kMissingSample | kDeviceLost), 0U);  // lost if this took a second
  rig_.setNow(rt::monotonicNs() - SharedMemoryDriver::kLostNs - test::SharedMemoryRig::kStepNs);
  rig_.elapse();
  EXPECT_EQ(exchange(0.0), kDeviceLost);
}

TEST_F(SharedMemoryDriverTest, FindsADeviceThatWasEndedAndStartedAgainByOpening) {
  play(5.0);
  rig_.endDevice();
  EXPECT_EQ(exchange(5.0), kDeviceLost);
  rig_.driver().makeSafe();  // into memory whose device has gone
  rig_.driver().rearm();
  rig_.restartDevice();
  EXPECT_EQ(exchange(5.0), kDeviceLost);
  play(4.0);
}

TEST_F(SharedMemoryDriverTest, ReconnectsToADeviceThatWasStartedAgain) {
  play(5.0);
  rig_.endDevice();
  EXPECT_EQ(exchange(5.0), kDeviceLost);
  EXPECT_THROW(rig_.driver().reconnect(), DeviceError);
  rig_.restartDevice();
  felt_ = 0.0;  // a new device tells of changes only
  rig_.elapse();
  EXPECT_EQ(exchange(5.0), kDeviceLost) << "not by itself";
  rig_.driver().reconnect();
  EXPECT_EQ(felt(), 0.0) << "nothing of before";
  EXPECT_EQ(exchange(3.0), kExchangeOk);
  EXPECT_EQ(felt(), 3.0);
}

TEST_F(SharedMemoryDriverTest, StaysSafeThroughAReconnection) {
  play(5.0);
  rig_.driver().makeSafe();
  rig_.endDevice();
  rig_.restartDevice();
  felt_ = 0.0;  // a new device tells of changes only
  rig_.elapse();
  rig_.driver().reconnect();
  EXPECT_EQ(exchange(5.0), kMadeSafe);
  EXPECT_EQ(felt(), 0.0);
  EXPECT_NE(SharedSegment::attach(rig_.name())->safe.load(), 0U);
  rig_.driver().rearm();
  EXPECT_EQ(exchange(5.0), kExchangeOk);
  EXPECT_EQ(felt(), 5.0);
}

TEST_F(SharedMemoryDriverTest, DoesNotReconnectToADeviceThatStandsStillOrToAnotherOne) {
  play(5.0);
  rig_.setNow(rt::monotonicNs() - SharedMemoryDriver::kLostNs - test::SharedMemoryRig::kStepNs);
  rig_.elapse();
  EXPECT_THROW(rig_.driver().reconnect(), DeviceError);
  rig_.endDevice();
  VirtualDeviceConfig other;
  other.shared_memory = rig_.name();
  other.rate_hz = 2.0 * test::SharedMemoryRig::kRateHz;
  other.bank.slices = 3;
  VirtualDevice device(other);
  device.step(rt::monotonicNs() + 1'000'000'000);
  EXPECT_THROW(rig_.driver().reconnect(), DeviceError);
}

TEST_F(SharedMemoryDriverTest, SetsTargetsOfTheHands) {
  EXPECT_FALSE(rig_.driver().setTarget(1, 0.01)) << "not open yet";
  rig_.driver().open(1000.0);
  EXPECT_TRUE(rig_.driver().setTarget(1, 0.01));
  EXPECT_FALSE(rig_.driver().setTarget(3, 0.01));
  EXPECT_FALSE(rig_.driver().setTarget(0, 0.1001));
  EXPECT_FALSE(rig_.driver().setTarget(0, std::nan("")));
  for (int n = 0; n < 5000; ++n) {
    exchange(0.0);
    rig_.elapse();
  }
  EXPECT_NEAR(x_[1], 0.01, 1e-9);
  EXPECT_EQ(x_[0], 0.0);
}

TEST_F(SharedMemoryDriverTest, DeclaresTheStepsThatForceAndPositionMayWait) {
  rig_.driver().open(1000.0);
  EXPECT_EQ(rig_.driver().extraDelayTicks(), 2);
  rig_.driver().open(100.0);
  EXPECT_EQ(rig_.driver().extraDelayTicks(), 1);
}

TEST(SharedMemoryTraitsTest, AreThoseOfTheDevice) {
  VirtualDeviceConfig device_config;
  device_config.shared_memory = test::freshSegmentName();
  device_config.rate_hz = 1000.0;
  device_config.bank.slices = 2;
  device_config.bank.slice.delay = 0.0015;
  device_config.bank.slice.damping = 0.6;
  SliceCalibration volts;
  volts.is_calibrated = true;
  volts.metres_per_volt = 0.005;
  volts.volts_per_newton = 0.05;
  device_config.bank.slice.volts = volts;
  VirtualDevice device(device_config);
  VirtualDriverConfig config;
  config.slices = 2;
  config.shared_memory = device_config.shared_memory;
  EXPECT_THROW(makeVirtualDriver(config)->open(1000.0), DeviceError) << "it speaks volts";
  config.is_raw = true;
  const auto driver = makeVirtualDriver(config);
  EXPECT_TRUE(driver->isRaw());
  driver->open(1000.0);
  EXPECT_EQ(driver->extraDelayTicks(), 4) << "two steps and the actuator";
  EXPECT_EQ(driver->damping(), 0.6);
  EXPECT_EQ(driver->declaredDamping(), 0.6);
  const std::array<double, 2> forces{0.5, 0.0};  // V
  std::array<double, 2> x{};
  driver->exchange(forces.data(), x.data());
  device.step(rt::monotonicNs());
  ForceRecord record;
  ASSERT_TRUE(device.pollForce(record));
  EXPECT_DOUBLE_EQ(record.force_n, 10.0);
}

TEST_F(SharedMemoryDriverTest, RefusesADeviceThatAnotherDriverHas) {
  rig_.driver().open(1000.0);
  const auto second = rig_.makeDriver();
  EXPECT_THROW(second->open(1000.0), DeviceError);
  rig_.driver().close();
  EXPECT_NO_THROW(second->open(1000.0));
}

TEST_F(SharedMemoryDriverTest, RefusesADeviceOfOtherSlices) {
  EXPECT_THROW(rig_.makeDriver(4)->open(1000.0), DeviceError);
}

TEST_F(SharedMemoryDriverTest, RefusesSettingsOfTheDeviceProcess) {
  VirtualDriverConfig config;
  config.shared_memory = rig_.name();
  config.extra_delay_ticks = 1;
  EXPECT_THROW(makeVirtualDriver(config), Exception);
  config.extra_delay_ticks = 0;
  config.gesture_file = "g.csv";
  EXPECT_THROW(makeVirtualDriver(config), Exception);
}

/// A station that is killed in the middle of playing, and the one after it.
TEST_F(SharedMemoryDriverTest, SurvivesTheDeathOfTheDriversProcess) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const auto driver = rig_.makeDriver();
    driver->open(1000.0);
    const ThreeSlices forces{15.0, 0.0, 0.0};
    ThreeSlices x{};
    driver->exchange(forces.data(), x.data());
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  for (int n = 0; n <= kWatchdogSteps; ++n) {
    EXPECT_EQ(felt(), 15.0) << n;
  }
  EXPECT_EQ(felt(), 0.0);
  rig_.driver().open(1000.0);
  EXPECT_EQ(exchange(3.0), kExchangeOk);
  EXPECT_EQ(felt(), 3.0);
}

}  // namespace
}  // namespace ergotic::tgr
