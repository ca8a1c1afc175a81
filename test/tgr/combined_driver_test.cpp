// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/combined_driver.hpp"

#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"
#include "tgr/scripted_driver.hpp"

namespace ergotic::tgr {
namespace {

using test::Script;

class CombinedDriverTest : public ::testing::Test {
 protected:
  std::unique_ptr<Driver> combined() {
    std::vector<std::unique_ptr<Driver>> drivers;
    for (Script& script : scripts_) {
      drivers.push_back(std::make_unique<test::ScriptedDevice>(script));
    }
    return combine(std::move(drivers));
  }

  std::array<Script, 3> scripts_;
  std::array<double, kMaxSlices> forces_{};
  std::array<double, kMaxSlices> positions_{};
};

TEST_F(CombinedDriverTest, PutsTheSlicesOfEachDeviceBehindThoseOfTheOneBefore) {
  scripts_[0].slices = 3;
  scripts_[1].slices = 1;
  scripts_[2].slices = 2;
  const auto driver = combined();
  driver->open(1000.0);
  EXPECT_EQ(driver->slices(), 6);
  scripts_[0].positions = {0.0, 0.1, 0.2};
  scripts_[1].positions = {0.3};
  scripts_[2].positions = {0.4, 0.5};
  for (std::size_t i = 0; i < 6; ++i) {
    forces_[i] = static_cast<double>(i);
  }
  EXPECT_EQ(driver->exchange(forces_.data(), positions_.data()), kExchangeOk);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(positions_[i], 0.1 * static_cast<double>(i));
  }
  EXPECT_EQ(scripts_[0].forces[2], 2.0);
  EXPECT_EQ(scripts_[1].forces[0], 3.0);
  EXPECT_EQ(scripts_[2].forces[1], 5.0);
  EXPECT_TRUE(driver->setTarget(3, 0.07));
  EXPECT_EQ(scripts_[1].target, std::make_pair(0, 0.07));
  EXPECT_TRUE(driver->setTarget(5, -0.07));
  EXPECT_EQ(scripts_[2].target, std::make_pair(1, -0.07));
  EXPECT_FALSE(driver->setTarget(6, 0.0));
}

TEST_F(CombinedDriverTest, CanHurtIfAnyOfThemCan) {
  const auto driver = combined();
  EXPECT_TRUE(driver->canHurt());
  for (Script& script : scripts_) {
    EXPECT_TRUE(driver->canHurt());
    script.can_hurt = false;
  }
  EXPECT_FALSE(driver->canHurt());
  EXPECT_FALSE(makeVirtualDriver({})->canHurt()) << "it is simulated";
}

TEST_F(CombinedDriverTest, IsSteppedByExchangesIfAllOfThemAre) {
  const auto driver = combined();
  for (Script& script : scripts_) {
    EXPECT_FALSE(driver->isSteppedByExchange());
    script.is_stepped_by_exchange = true;
  }
  EXPECT_TRUE(driver->isSteppedByExchange());
}

TEST_F(CombinedDriverTest, MeetsWhatAnyOfThemMeets) {
  const auto driver = combined();
  driver->open(1000.0);
  scripts_[1].flags = kMissingSample;
  scripts_[2].flags = kDeviceLost;
  EXPECT_EQ(driver->exchange(forces_.data(), positions_.data()), kMissingSample | kDeviceLost);
  scripts_[0].uncalibrated = 0b10;
  scripts_[2].uncalibrated = 0b11;
  EXPECT_EQ(driver->uncalibrated(), 0b110010U);
  scripts_[1].extra_delay_ticks = 3;
  EXPECT_EQ(driver->extraDelayTicks(), 3);
  scripts_[1].damping = 0.5;
  EXPECT_EQ(driver->damping(), 0.5) << "what is passive with the least is passive with all";
  EXPECT_EQ(driver->declaredDamping(), 0.05);
}

TEST_F(CombinedDriverTest, MakesAllOfThemSafeAndRearmsAll) {
  const auto driver = combined();
  driver->makeSafe();
  for (const Script& script : scripts_) {
    EXPECT_TRUE(script.is_safe);
  }
  driver->rearm();
  for (const Script& script : scripts_) {
    EXPECT_FALSE(script.is_safe);
  }
}

TEST_F(CombinedDriverTest, TicksByTheClockOfTheOneThatHasOne) {
  EXPECT_EQ(combined()->clock(), nullptr);
  scripts_[1].has_clock = true;
  EXPECT_NE(combined()->clock(), nullptr);
}

TEST_F(CombinedDriverTest, ClosesThoseThatOpenedIfAnotherDoesNot) {
  const auto driver = combined();
  scripts_[2].opens = false;
  EXPECT_THROW(driver->open(1000.0), DeviceError);
  EXPECT_FALSE(scripts_[0].is_open);
  EXPECT_FALSE(scripts_[1].is_open);
  scripts_[2].opens = true;
  driver->open(1000.0);
  EXPECT_TRUE(scripts_[2].is_open);
  driver->close();
  EXPECT_FALSE(scripts_[2].is_open);
}

TEST_F(CombinedDriverTest, ReconnectsTheOthersAlthoughOneStaysLost) {
  const auto driver = combined();
  driver->open(1000.0);
  scripts_[0].reconnects = false;
  EXPECT_THROW(driver->reconnect(), DeviceError);
  EXPECT_EQ(scripts_[1].reconnections, 1);
  EXPECT_EQ(scripts_[2].reconnections, 1);
}

/// Two devices of 40 and 24 slices; a spring between slice i of the first and slice i of the
/// second.
TEST(CombinedDevicesTest, FeelEachOtherThroughASpringBetweenThem) {
  std::vector<std::unique_ptr<Driver>> devices;
  devices.push_back(test::makePlainVirtual(40));
  devices.push_back(test::makePlainVirtual(24));
  const auto driver = combine(std::move(devices));
  driver->open(3000.0);
  ASSERT_EQ(driver->slices(), kMaxSlices);
  const double stiffness = 800.0;
  const double hand = VirtualSliceConfig{}.hand_stiffness;
  std::array<double, kMaxSlices> forces{};
  std::array<double, kMaxSlices> x{};
  for (int i = 0; i < 24; ++i) {
    ASSERT_TRUE(driver->setTarget(i, 1e-3 * i));
  }
  for (int n = 0; n < 12000; ++n) {
    driver->exchange(forces.data(), x.data());
    for (std::size_t i = 0; i < 24; ++i) {
      forces[i] = stiffness * (x[40 + i] - x[i]);
      forces[40 + i] = -forces[i];
    }
  }
  for (std::size_t i = 0; i < 24; ++i) {
    const double stretch = 1e-3 * static_cast<double>(i) * hand / (hand + 2.0 * stiffness);
    EXPECT_NEAR(x[i] - x[40 + i], stretch, 1e-9) << i;
    EXPECT_NEAR(x[40 + i], stiffness * stretch / hand, 1e-9) << i;
  }
  EXPECT_EQ(x[30], 0.0) << "has no spring";
}

TEST_F(CombinedDriverTest, RefusesWhatDoesNotGoTogether) {
  EXPECT_EQ(complaintOf([] { combine({}); }), "no device to combine, allowed: one or more");
  scripts_[0].slices = 40;
  scripts_[1].slices = 22;
  EXPECT_EQ(combined()->slices(), kMaxSlices);
  scripts_[1].slices = 23;
  EXPECT_EQ(complaintOf([this] { combined(); }),
            "65 slices in all devices together, allowed: at most 64");
  scripts_[1].slices = 2;
  scripts_[1].has_clock = true;
  scripts_[2].has_clock = true;
  EXPECT_EQ(complaintOf([this] { combined(); }),
            "2 devices with a clock of their own, allowed: at most one");
  scripts_[2].is_raw = true;
  EXPECT_EQ(complaintOf([this] { combined(); }),
            "a device that speaks volts cannot be combined without its calibration");
}

TEST_F(CombinedDriverTest, PutsTheValuesOfAllGesturesInOrderOfTime) {
  const test::ScratchFile files[] = {test::ScratchFile("1,$a,1\n3,$a,2\n"),
                                     test::ScratchFile("2,$b,3\n")};
  std::vector<std::unique_ptr<Driver>> drivers;
  for (const test::ScratchFile& file : files) {
    VirtualDriverConfig config;
    config.slices = 1;
    config.gesture_file = file.path();
    drivers.push_back(makeVirtualDriver(config));
  }
  drivers.push_back(std::make_unique<test::ScriptedDevice>(scripts_[0]));
  const auto driver = combine(std::move(drivers));
  std::string order;
  for (const GestureValue& value : driver->gestureValues()) {
    order += value.parameter;
  }
  EXPECT_EQ(order, "aba");
  driver->open(1000.0);
  driver->exchange(forces_.data(), positions_.data());
  EXPECT_DOUBLE_EQ(driver->gestureTime(), 1e-3);
}

}  // namespace
}  // namespace ergotic::tgr
