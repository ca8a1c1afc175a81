// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <thread>

#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"

namespace ergotic::tgr {
namespace {

using Slices = std::array<double, kMaxSlices>;

TEST(SharedFrameThreadsTest, GivesWholeFramesOnly) {
  constexpr int kFrames = 3000;  // different ones, to be seen by the reader
  SharedFrame frame;
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    Slices values;
    for (double n = 1.0; !stop; n += 1.0) {
      values.fill(n);
      frame.write(values.data(), kMaxSlices);
      std::this_thread::yield();
    }
  });
  int seen = 0;
  int torn = 0;
  int backwards = 0;
  double last = 0.0;
  while (seen < kFrames) {
    Slices values;
    if (!frame.read(values.data(), kMaxSlices) || values[0] == last) {
      std::this_thread::yield();
      continue;
    }
    for (const double value : values) {
      torn += value != values[0] ? 1 : 0;
    }
    backwards += values[0] < last ? 1 : 0;
    ++seen;
    last = values[0];
  }
  stop = true;
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(backwards, 0);
}

/// Rounds of makeSafe and rearm from another thread while this one exchanges.
template <class Rig>
void exchangeWhileMadeSafe() {
  constexpr int kRounds = 2000;
  Rig rig;
  Driver& driver = rig.driver();
  driver.open(1000.0);
  std::atomic<int> begun{0};  // exchanges that began
  std::atomic<bool> latched{false};
  std::atomic<bool> done{false};
  std::thread guard([&] {
    const auto waitForTwo = [&] {
      const int from = begun;
      while (begun < from + 2) {
        std::this_thread::yield();
      }
    };
    for (int round = 0; round < kRounds; ++round) {
      driver.makeSafe();
      latched = true;
      waitForTwo();
      latched = false;
      driver.rearm();
      waitForTwo();
    }
    done = true;
  });
  Slices forces;
  forces.fill(1.0);
  Slices positions{};
  int must_be_safe = 0;
  int was_safe = 0;
  int was_armed = 0;
  while (!done) {
    ++begun;
    const bool before = latched;
    const std::uint32_t flags = driver.exchange(forces.data(), positions.data());
    const bool throughout = before && latched;
    must_be_safe += throughout ? 1 : 0;
    was_safe += throughout && (flags & kMadeSafe) != 0 ? 1 : 0;
    was_armed += (flags & kMadeSafe) == 0 ? 1 : 0;
    rig.elapse();
    std::this_thread::yield();
  }
  guard.join();
  EXPECT_GE(must_be_safe, kRounds / 2);
  EXPECT_EQ(was_safe, must_be_safe);
  EXPECT_GE(was_armed, kRounds / 2);
}

TEST(DriverThreadsTest, MadeSafeByAnotherThreadIsSafeFromTheNextExchangeOn) {
  exchangeWhileMadeSafe<test::InProcessRig>();
  exchangeWhileMadeSafe<test::SharedMemoryRig>();
  exchangeWhileMadeSafe<test::ReplayRig>();
  exchangeWhileMadeSafe<test::FaultyRig>();
  exchangeWhileMadeSafe<test::CombinedRig>();
  exchangeWhileMadeSafe<test::CalibratedRig>();
}

TEST(DriverThreadsTest, TakesCalibrationsAndFaultsWhileTicksGoOn) {
  constexpr int kRounds = 500;
  SliceCalibration plain;
  plain.is_calibrated = true;
  plain.metres_per_volt = 0.001;
  plain.volts_per_newton = 0.05;
  SliceCalibration narrow = plain;  // 4 mm at 0 V
  narrow.rest_volts = -4.0;
  SliceCalibration wide = plain;  // 2 mm; of half the one and half the other 1 or 8 mm
  wide.metres_per_volt = 0.002;
  wide.rest_volts = -1.0;
  VirtualDriverConfig config;
  config.slices = 1;
  config.slice = test::plainSlice();
  config.slice.volts = plain;
  auto calibrated = makeCalibratedDriver(makeVirtualDriver(config), {{narrow}});
  CalibratedDriver& calibration = *calibrated;
  const auto faulty = makeFaultyDriver(std::move(calibrated));
  faulty->open(1000.0);
  const double force = 0.0;
  std::atomic<int> begun{0};  // exchanges that began
  std::atomic<bool> done{false};
  std::thread operators([&] {
    for (int round = 0; round < kRounds; ++round) {
      // The first may have missed the change before; the second goes by it, and has ended at the
      // third.
      const int from = begun;
      while (begun < from + 3) {
        std::this_thread::yield();
      }
      calibration.set(0, round % 2 == 0 ? wide : narrow);
      faulty->inject({InjectedFault::kJump, 0, 1, 0.5});
      double volts = 0.0;
      calibration.readVolts(&volts);
    }
    done = true;
  });
  int other = 0;
  int met = 0;
  int jumps = 0;
  while (!done) {
    double x = 0.0;
    ++begun;
    faulty->exchange(&force, &x);
    const bool jumped = x > 0.4;
    jumps += jumped ? 1 : 0;
    const double place = jumped ? x - 0.5 : x;
    const bool is_away = calibration.uncalibrated() != 0;  // for one exchange after each change
    const bool is_either = std::abs(place - 0.004) < 1e-6 || std::abs(place - 0.002) < 1e-6;
    other += is_away || is_either ? 0 : 1;
    met += is_away ? 0 : 1;
    std::this_thread::yield();
  }
  operators.join();
  EXPECT_EQ(other, 0) << "neither of the two calibrations";
  EXPECT_GE(met, kRounds);
  EXPECT_GE(jumps, kRounds - 1);
}

TEST(DriverThreadsTest, PushesAndEndsPushesWhileTicksGoOn) {
  constexpr int kRounds = 500;
  constexpr int kPatience = 300;
  SliceCalibration plain;
  plain.is_calibrated = true;
  plain.metres_per_volt = 0.001;
  plain.volts_per_newton = 0.05;
  VirtualDriverConfig config;
  config.slices = 1;
  config.slice = test::plainSlice();
  config.slice.volts = plain;
  const auto driver = makeCalibratedDriver(makeVirtualDriver(config), {{plain}});
  driver->open(1000.0);
  std::atomic<bool> done{false};
  std::thread ticks([&] {
    const double force = 0.0;
    double x = 0.0;
    while (!done) {
      driver->exchange(&force, &x);
      std::this_thread::yield();
    }
  });
  int told = 0;
  for (int round = 0; round < kRounds; ++round) {
    driver->push(0, kPushN);
    for (int i = 0; i < round % kPatience; ++i) {
      std::this_thread::yield();
      told += driver->takePush() ? 1 : 0;
    }
    driver->endPush();
    EXPECT_FALSE(driver->takePush().has_value()) << "it was ended";
  }
  done = true;
  ticks.join();
  EXPECT_LE(told, kRounds);
}

TEST(DriverThreadsTest, TakesEveryTargetThatAnotherThreadSets) {
  constexpr int kTargets = 20000;
  test::InProcessRig rig;
  rig.driver().open(1000.0);
  std::atomic<bool> done{false};
  int taken = 0;
  std::thread player([&] {
    while (taken < kTargets) {
      const double target = taken + 1 < kTargets ? 1e-6 * taken : -0.01;
      taken += rig.driver().setTarget(1, target) ? 1 : 0;
      std::this_thread::yield();
    }
    done = true;
  });
  const Slices forces{};
  Slices positions{};
  while (!done) {
    rig.driver().exchange(forces.data(), positions.data());
    std::this_thread::yield();
  }
  player.join();
  EXPECT_EQ(taken, kTargets);
  for (int n = 0; n < 5000; ++n) {
    rig.driver().exchange(forces.data(), positions.data());
  }
  EXPECT_NEAR(positions[1], -0.01, 1e-9) << "the last one, and in order";
}

/// The device as it really runs: on a clock of its own. Counts what it felt; times are not asked.
TEST(DriverThreadsTest, DeviceOnItsOwnClockFeelsAndReleasesForce) {
  VirtualDeviceConfig device_config;
  device_config.shared_memory = test::freshSegmentName();
  device_config.watchdog_s = 5.0;
  VirtualDevice device(device_config);
  std::atomic<bool> stop{false};
  std::thread mechanics([&] { device.run(stop); });
  VirtualDriverConfig config;
  config.shared_memory = device_config.shared_memory;
  const auto driver = makeVirtualDriver(config);
  driver->open(1000.0);
  Slices forces;
  forces.fill(15.0);
  Slices positions{};
  const auto countRecords = [&](double force, int wanted) {
    int count = 0;
    ForceRecord record;
    while (count < wanted) {
      count += device.pollForce(record) && record.force_n == force ? 1 : 0;
      std::this_thread::yield();
    }
    return count;
  };
  driver->exchange(forces.data(), positions.data());
  EXPECT_EQ(countRecords(15.0, config.slices), config.slices);
  driver->makeSafe();  // and no exchange any more, as if the process had died
  EXPECT_EQ(countRecords(0.0, config.slices), config.slices);
  driver->rearm();
  while (positions[0] <= 0.0 || positions[11] <= 0.0) {
    driver->exchange(forces.data(), positions.data());
    std::this_thread::yield();
  }
  stop = true;
  mechanics.join();
  EXPECT_EQ(device.droppedRecords(), 0);
}

}  // namespace
}  // namespace ergotic::tgr
