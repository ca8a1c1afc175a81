// SPDX-License-Identifier: BSD-3-Clause
#include "comedi/comedi_rig.hpp"
#include "ergotic/tgr/calibration.hpp"
#include "ergotic/tgr/device.hpp"
#include "support/driver_contract.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

/// The driver as a station uses it: made to speak metres and newtons.

namespace ergotic::test {
namespace {

tgr::SliceCalibration plainCalibration() {
  tgr::SliceCalibration calibration;
  calibration.is_calibrated = true;
  calibration.metres_per_volt = kMetresPerVolt;
  calibration.rest_volts = comediVolts(kMidCount);
  calibration.volts_per_newton = 1.0 / kNewtonsPerVolt;
  calibration.zero_volts = comediVolts(kMidCount);
  return calibration;
}

class CalibratedComediRig {
 public:
  static constexpr bool kFeelsForce = true;
  tgr::Driver& driver() { return *driver_; }
  void elapse() {}

 private:
  std::unique_ptr<tgr::Driver> driver_ = tgr::makeCalibratedDriver(
      ComediRig().release(), {{plainCalibration(), plainCalibration(), plainCalibration()}});
};

/// A board whose sensors and actuators are off in every way.
ComediStandinBoard crookedBoard() {
  ComediStandinBoard board = plainBoard();
  board.metres_per_volt = -0.0028;
  board.rest_volts = 0.37;
  board.newtons_per_volt = 17.0;
  board.no_force_volts = 0.005;
  return board;
}

class ComediCalibrationTest : public ::testing::Test {
 protected:
  using Slices = std::array<double, tgr::kMaxSlices>;

  void SetUp() override { driver_->open(1000.0); }

  Slices settle(double force) {
    Slices forces;
    forces.fill(force);
    Slices positions{};
    for (int n = 0; n < 3000; ++n) {
      EXPECT_EQ(driver_->exchange(forces.data(), positions.data()), tgr::kExchangeOk);
    }
    return positions;
  }

  /// What a data sheet says, and an amplifier's offset, before the sensor was looked at.
  static tgr::SliceCalibration actuatorOnly() {
    tgr::SliceCalibration calibration;
    calibration.volts_per_newton = 1.0 / 17.0;
    calibration.zero_volts = 0.005;
    return calibration;
  }

  /// A hand holds channel 0, and its sensor is read, as the guided calibration does.
  tgr::CalibrationPoint measure(double position_m) {
    comediStandinHold(0, position_m);
    settle(0.0);
    Slices volts{};
    driver_->readVolts(volts.data());
    return {position_m, volts[0], 0.0};
  }

  const ComediStandinBoard board_ = crookedBoard();
  std::unique_ptr<tgr::CalibratedDriver> driver_ = tgr::makeCalibratedDriver(
      ComediRig(board_, "{ai_channels: [0], ao_channels: [0], safe_volts: 0.005}").release(),
      {{actuatorOnly()}});
};

TEST_F(ComediCalibrationTest, FindsPositionsAndForcesOfACrookedBoard) {
  EXPECT_EQ(driver_->uncalibrated(), 1U);
  const tgr::SliceCalibration calibration =
      tgr::fit({measure(-0.02), measure(0.0), measure(0.02)}, actuatorOnly(), 1e-4);
  EXPECT_NEAR(calibration.metres_per_volt, board_.metres_per_volt, 1e-6);
  EXPECT_NEAR(calibration.rest_volts, board_.rest_volts, 1e-3);
  driver_->set(0, calibration);
  constexpr double kCountM = 0.0028 * kVoltsPerCount;  // of the input
  const double output_count_m = 17.0 * kVoltsPerCount / board_.slice.hand_stiffness;
  comediStandinHold(0, 0.005);
  EXPECT_NEAR(settle(0.0)[0], 0.005, 2.0 * kCountM);
  EXPECT_EQ(driver_->uncalibrated(), 0U) << "from the first exchange with the new calibration on";
  EXPECT_NEAR(settle(3.0)[0], 0.005 + 3.0 / board_.slice.hand_stiffness,
              2.0 * kCountM + output_count_m);
  EXPECT_NEAR(settle(-3.0)[0], 0.005 - 3.0 / board_.slice.hand_stiffness,
              2.0 * kCountM + output_count_m);
}

TEST_F(ComediCalibrationTest, GivesNoForceToAnUncalibratedSlice) {
  settle(10.0);
  EXPECT_NEAR(comediStandinOutputVolts(0), 0.005, 0.5 * kVoltsPerCount);
}

TEST(ComediRailTest, ASliceAtItsEndStopHasAPosition) {
  const ComediStandinBoard board;
  comediStandinReset(&board);
  const std::string file = repository("config/comedi.yaml");
  const tgr::DriverStack stack = tgr::makeDrivers(
      tgr::readDevices(textOf(file), file),
      [](const std::string&, const YAML::Node& settings, const std::string& place) {
        return tgr::ComediFactory().make(settings, place);
      },
      false);
  stack.driver->open(board.rate_hz);
  const Volts forces{};
  Volts positions{};
  for (const double beyond : {0.1, -0.1}) {
    comediStandinHold(0, beyond);
    for (int n = 0; n < 3000; ++n) {
      ASSERT_EQ(stack.driver->exchange(forces.data(), positions.data()), tgr::kExchangeOk);
      ASSERT_TRUE(std::isfinite(positions[0])) << n;
    }
    EXPECT_NEAR(positions[0], std::copysign(board.slice.stop, beyond), 1e-3);
  }
  ComediRig::inject(ComediFault::kRail);
  stack.driver->exchange(forces.data(), positions.data());
  EXPECT_TRUE(std::isnan(positions[0]));
}

TEST(ComediRailTest, ASensorAtItsRailHasNoPosition) {
  ComediRig rig;
  const auto driver = tgr::makeCalibratedDriver(
      rig.release(), {{plainCalibration(), plainCalibration(), plainCalibration()}});
  driver->open(1000.0);
  ComediRig::inject(ComediFault::kRail);
  const Volts forces{};
  Volts positions{};
  EXPECT_EQ(driver->exchange(forces.data(), positions.data()), tgr::kExchangeOk);
  EXPECT_TRUE(std::isnan(positions[1])) << "slice 1 is at channel 0";
  EXPECT_EQ(positions[0], 0.0);
  driver->exchange(forces.data(), positions.data());
  EXPECT_EQ(positions[1], 0.0);
}

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Comedi, DriverContractTest, CalibratedComediRig);

}  // namespace ergotic::test
