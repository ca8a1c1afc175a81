// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/calibration.hpp"

#include "support/test.hpp"
#include "tgr/calibration_rules.hpp"
#include "tgr/scripted_driver.hpp"

namespace ergotic::tgr {
namespace {

using test::someCalibration;

std::vector<CalibrationPoint> pointsOf(const SliceCalibration& c, std::vector<double> positions) {
  std::vector<CalibrationPoint> points;
  for (const double x : positions) {
    points.push_back({x, c.rest_volts + x / c.metres_per_volt, 1e-3});
  }
  return points;
}

TEST(CalibrationFitTest, FindsTheLineThroughThePlaces) {
  for (const double gain : {0.005, -0.02}) {
    SliceCalibration truth = someCalibration();
    truth.metres_per_volt = gain;
    SliceCalibration from = truth;
    from.is_calibrated = false;
    from.metres_per_volt = 0.0;
    from.rest_volts = 0.0;
    const SliceCalibration found = fit(pointsOf(truth, {-0.02, 0.01, 0.02}), from, 1e-4);
    EXPECT_TRUE(found.is_calibrated);
    EXPECT_NEAR(found.metres_per_volt, truth.metres_per_volt, 1e-15);
    EXPECT_NEAR(found.rest_volts, truth.rest_volts, 1e-12);
    EXPECT_NEAR(found.residual_m, 0.0, 1e-12);
    EXPECT_NEAR(found.noise_m, 1e-3 * std::abs(gain), 1e-12);
    EXPECT_EQ(found.volts_per_newton, truth.volts_per_newton) << "taken from before";
    EXPECT_EQ(found.high_volts, truth.high_volts);
  }
}

TEST(CalibrationFitTest, GivesTheResidualOfPlacesOffTheLine) {
  const SliceCalibration truth = someCalibration();
  auto points = pointsOf(truth, {-0.02, -0.01, 0.01, 0.02});
  // Off by e, -e, -e, e, which is independent of the volts -4, -2, 2, 4 about their mean.
  const double off = 0.02;
  const std::array<double, 4> sign{1.0, -1.0, -1.0, 1.0};
  for (std::size_t i = 0; i < 4; ++i) {
    points[i].mean_volts += off * sign[i];
  }
  const double spread = 1.0 + off * off / 10.0;
  const SliceCalibration found = fit(points, truth, 1e-3);
  EXPECT_NEAR(found.metres_per_volt, 0.005 / spread, 1e-15);
  EXPECT_NEAR(found.residual_m, 0.005 * off / std::sqrt(spread), 1e-15);
  EXPECT_THAT(
      complaintOf([&] { fit(points, truth, 5e-5); }),
      testing::StartsWith("the readings of the sensor do not lie on a straight line over the "
                          "positions: residual 9.99980"));
}

TEST(CalibrationFitTest, RefusesNonsense) {
  const SliceCalibration from = someCalibration();
  const auto complaint = [&](const std::vector<CalibrationPoint>& points) {
    return complaintOf([&] { fit(points, from, 1e-3); });
  };
  EXPECT_EQ(complaint({{0.0, 1.0, 0.0}}),
            "1 positions to calibrate from, allowed: two or more, as far apart as can be");
  EXPECT_EQ(complaint({{0.0, 1.0, 0.0}, {0.0005, 2.0, 0.0}}),
            "the places are within 0.0005 m, allowed: at least 0.001 m apart");
  EXPECT_EQ(complaint({{-0.02, 1.0, 1e-5}, {0.02, 1.0005, 1e-5}}),
            "the slice was not moved, or its sensor is not connected: 0.0005 V between the places, "
            "allowed: at least 0.001 V");
  EXPECT_EQ(complaint({{-0.02, 1.0, 0.3}, {0.02, 3.0, 0.3}}),
            "the sensor's noise of 0.3 V rms is too large for a stroke of 2 V, allowed: at most a "
            "tenth of it");
  EXPECT_EQ(complaint({{-0.02, 1.0, 0.0}, {0.02, 8.0, 0.0}}),
            "the sensor is at its rail at 0.02 m: 8 V, allowed: between -5 and 8 V");
  EXPECT_EQ(complaint({{-0.02, std::nan(""), 0.0}, {0.02, 3.0, 0.0}}),
            "mean of the sensor at -0.02 m = nan V is out of range, allowed: -1000...1000 V");
  EXPECT_EQ(complaint({{-0.02, 1.0, 0.0}, {std::nan(""), 3.0, 0.0}}),
            "position of a place = nan m is out of range, allowed: -1...1 m");
}

TEST(CalibrationFitTest, AsksForTheGainOfTheForceThatItCannotKnow) {
  const auto points = pointsOf(someCalibration(), {-0.02, 0.02});
  EXPECT_EQ(complaintOf([&] { fit(points, {}, 1e-3); }),
            "metres_per_volt = 0.005 and volts_per_newton = 0, allowed: neither is 0 in a slice "
            "that is calibrated");
}

TEST(CalibrationYamlTest, ReadsBackWhatItWrites) {
  Calibration calibration;
  calibration.slices = {someCalibration(), {}, someCalibration(), {}};
  calibration.slices[2].metres_per_volt = -1.0 / 3.0;
  calibration.slices[2].residual_m = 2e-5;
  calibration.slices[3].volts_per_newton = 0.25;
  const Calibration read = readCalibration(toYaml(calibration), "c.yaml");
  ASSERT_EQ(read.slices.size(), 4U);
  EXPECT_TRUE(read.slices[0].is_calibrated);
  EXPECT_EQ(read.slices[0].zero_volts, 0.004);
  EXPECT_FALSE(read.slices[1].is_calibrated);
  EXPECT_EQ(read.slices[2].metres_per_volt, -1.0 / 3.0);
  EXPECT_EQ(read.slices[2].residual_m, 2e-5);
  EXPECT_FALSE(read.slices[3].is_calibrated);
  EXPECT_EQ(read.slices[3].volts_per_newton, 0.25);
  EXPECT_EQ(toYaml(read), toYaml(calibration));
  EXPECT_TRUE(readCalibration(toYaml({}), "c.yaml").slices.empty());
}

TEST(CalibrationYamlTest, SaysWhereATextIsWrong) {
  const auto complaint = [](const std::string& text) {
    return complaintOf([&] { readCalibration(text, "c.yaml"); });
  };
  EXPECT_EQ(complaint("slices:\n  - ~\n  - {metres_per_volt: 11, volts_per_newton: 1}\n"),
            "c.yaml:3:23: error: 'metres_per_volt' of calibration of slice 1 = 11 m/V is out of "
            "range, allowed: -10...10 m/V");
  EXPECT_EQ(complaint("slices: [{metres_per_volt: 0.01, volts_per_newton: 0}]"),
            "c.yaml:1:10: error: metres_per_volt = 0.01 and volts_per_newton = 0 of calibration of "
            "slice 0, "
            "allowed: neither is 0 in a slice that is calibrated");
  EXPECT_EQ(
      complaint("slices: [{low_volts: 3, high_volts: 3}]"),
      "c.yaml:1:10: error: high_volts of calibration of slice 0 = 3 V is out of range, allowed: "
      "above 3...1000 V");
  EXPECT_EQ(
      complaint("slices: [{zero_volts: 0.2, volts_per_newton: 1}]"),
      "c.yaml:1:10: error: zero_volts of calibration of slice 0 = 0.2 V is out of range, allowed: "
      "-0.1...0.1 V");
  EXPECT_EQ(complaint("slices: [{gain: 1}]").substr(0, 60),
            "c.yaml:1:11: error: unknown key 'gain' of calibration of sli");
  EXPECT_EQ(complaint("slices: 3"),
            "c.yaml:1:9: error: calibration of the slices is a single value, allowed: a list of at "
            "most 64 maps, one for each slice from 0 on");
  EXPECT_EQ(complaint("slices: [3]"),
            "c.yaml:1:10: error: calibration of slice 0 is a single value, allowed: a map");
  EXPECT_EQ(complaint("{}").substr(0, 27), "c.yaml:1:1: error: missing ");
}

TEST(CalibrationFullScaleTest, MustNotContradictTheGain) {
  SliceCalibration calibration = someCalibration();  // 4 V, -0.05 V/N
  for (const double same : {0.0, 75.0, 80.0, 85.0}) {
    calibration.full_scale_newtons = same;
    EXPECT_EQ(complaintOf([&] { checkCalibration(calibration, ""); }), "") << same;
  }
  for (const double other : {8.0, 70.0, 90.0, 800.0}) {
    calibration.full_scale_newtons = other;
    EXPECT_THAT(complaintOf([&] { checkCalibration(calibration, " of slice 2"); }),
                HasSubstr("of slice 2 make 80 N of full scale, full_scale_newtons says"))
        << other;
  }
}

class CalibratedDriverTest : public ::testing::Test {
 protected:
  CalibratedDriverTest() { script_.is_raw = true; }

  CalibratedDriver& open(Calibration calibration) {
    driver_ = makeCalibratedDriver(std::make_unique<test::ScriptedDevice>(script_),
                                   std::move(calibration));
    driver_->open(1000.0);
    return *driver_;
  }
  std::uint32_t exchange() { return driver_->exchange(forces_.data(), positions_.data()); }

  test::Script script_;
  std::unique_ptr<CalibratedDriver> driver_;
  std::array<double, 2> forces_{};
  std::array<double, 2> positions_{};
};

TEST_F(CalibratedDriverTest, SpeaksMetresAndNewtons) {
  EXPECT_FALSE(open({{someCalibration(), someCalibration()}}).isRaw());
  script_.positions = {3.0, -1.0};
  forces_ = {10.0, -20.0};
  EXPECT_EQ(exchange(), kExchangeOk);
  EXPECT_DOUBLE_EQ(positions_[0], 0.005);
  EXPECT_DOUBLE_EQ(positions_[1], -0.015);
  EXPECT_DOUBLE_EQ(script_.forces[0], 0.004 - 0.5);
  EXPECT_DOUBLE_EQ(script_.forces[1], 0.004 + 1.0);
  std::array<double, 2> volts{};
  driver_->readVolts(volts.data());
  EXPECT_EQ(volts, (std::array<double, 2>{3.0, -1.0}));
}

TEST_F(CalibratedDriverTest, StaysWithinTheRangeOfTheOutput) {
  SliceCalibration strong = someCalibration();
  strong.volts_per_newton = 0.01;
  strong.zero_volts = 0.0;
  open({{someCalibration(), strong}});
  forces_ = {1000.0, 1000.0};
  exchange();
  EXPECT_EQ(script_.forces[0], -4.0);
  EXPECT_EQ(script_.forces[1], 0.01 * kAbsoluteForceLimitN);
  forces_ = {-std::numeric_limits<double>::infinity(), std::nan("")};
  exchange();
  EXPECT_EQ(script_.forces[0], 4.0);
  EXPECT_EQ(script_.forces[1], 0.0) << "not a number is no force";
}

TEST_F(CalibratedDriverTest, GivesNoNumberForASensorAtItsRail) {
  open({{someCalibration(), someCalibration()}});
  for (const double volts : {-5.0, -7.0, 8.0, 9.0, std::nan("")}) {
    script_.positions = {volts, 2.0};
    exchange();
    EXPECT_TRUE(std::isnan(positions_[0])) << volts;
    EXPECT_EQ(positions_[1], 0.0);
  }
  script_.positions = {7.9999, 2.0};
  exchange();
  EXPECT_DOUBLE_EQ(positions_[0], 0.005 * 5.9999);
}

TEST_F(CalibratedDriverTest, HoldsThePositionsOfALostDevice) {
  open({{someCalibration(), someCalibration()}});
  script_.positions = {3.0, 4.0};
  exchange();
  script_.flags = kDeviceLost;
  script_.positions = {99.0, 0.0};
  EXPECT_EQ(exchange(), kDeviceLost);
  EXPECT_DOUBLE_EQ(positions_[0], 0.005);
  EXPECT_DOUBLE_EQ(positions_[1], 0.01);
}

TEST_F(CalibratedDriverTest, LetsASliceWithoutCalibrationNeitherMoveNorPush) {
  open({{{}, someCalibration()}});
  EXPECT_EQ(driver_->uncalibrated(), 1U);
  script_.positions = {5.0, 3.0};
  forces_ = {20.0, 0.0};
  exchange();
  EXPECT_EQ(positions_[0], 0.0);
  EXPECT_EQ(script_.forces[0], 0.0);
  EXPECT_EQ(script_.forces[1], 0.004) << "no force";
  driver_->set(0, someCalibration());
  EXPECT_EQ(driver_->uncalibrated(), 1U) << "until the exchange that goes by it";
  exchange();
  EXPECT_EQ(driver_->uncalibrated(), 0U);
  EXPECT_DOUBLE_EQ(positions_[0], 0.015);
  EXPECT_DOUBLE_EQ(script_.forces[0], 0.004 - 1.0);
  driver_->set(1, {});
  EXPECT_TRUE(driver_->calibration().slices[0].is_calibrated);
  exchange();
  EXPECT_EQ(driver_->uncalibrated(), 2U);
  EXPECT_EQ(positions_[1], 0.0);
}

TEST_F(CalibratedDriverTest, TakesASliceAwayForOneExchangeWhenItIsCalibratedAnew) {
  open({{someCalibration(), someCalibration()}});
  script_.positions = {5.0, 3.0};
  forces_ = {20.0, 20.0};
  exchange();
  SliceCalibration other = someCalibration();
  other.metres_per_volt *= 2.0;
  driver_->set(0, other);
  exchange();
  EXPECT_EQ(driver_->uncalibrated(), 1U) << "so that its port glides to where the hand is now";
  EXPECT_EQ(positions_[0], 0.0);
  EXPECT_EQ(script_.forces[0], 0.004) << "no force";
  EXPECT_DOUBLE_EQ(script_.forces[1], 0.004 - 1.0);
  exchange();
  EXPECT_EQ(driver_->uncalibrated(), 0U);
  EXPECT_DOUBLE_EQ(positions_[0], 0.03);
}

TEST(CalibrationCheckTest, HoldsForTheGainsThatWereChecked) {
  SliceCalibration c = someCalibration();
  EXPECT_FALSE(isChecked(c));
  c.checked = c.metres_per_volt * c.volts_per_newton;
  EXPECT_TRUE(isChecked(c));
  EXPECT_TRUE(isChecked(readCalibration(toYaml(Calibration{{c}}), "c.yaml").slices.at(0)));
  c.volts_per_newton *= -1.0;
  EXPECT_FALSE(isChecked(c));
}

TEST_F(CalibratedDriverTest, TakesSlicesThatNobodyCalibratedForUncalibrated) {
  EXPECT_EQ(open({}).uncalibrated(), 3U);
  EXPECT_EQ(driver_->calibration().slices.size(), 2U);
}

TEST_F(CalibratedDriverTest, PassesTheRestOn) {
  script_.extra_delay_ticks = 2;
  script_.damping = 1.5;
  script_.has_clock = true;
  open({});
  EXPECT_EQ(driver_->extraDelayTicks(), 2);
  EXPECT_EQ(driver_->damping(), 1.5);
  EXPECT_DOUBLE_EQ(driver_->declaredDamping(), 0.15);
  EXPECT_NE(driver_->clock(), nullptr);
  EXPECT_TRUE(driver_->setTarget(1, 0.01));
  EXPECT_EQ(script_.target, std::make_pair(1, 0.01));
  driver_->reconnect();
  EXPECT_EQ(script_.reconnections, 1);
  driver_->makeSafe();
  EXPECT_TRUE(script_.is_safe);
  driver_->rearm();
  EXPECT_FALSE(script_.is_safe);
  driver_->close();
  EXPECT_FALSE(script_.is_open);
  EXPECT_TRUE(driver_->canHurt());
  script_.can_hurt = false;
  EXPECT_FALSE(driver_->canHurt());
}

TEST_F(CalibratedDriverTest, RefusesWhatDoesNotFit) {
  EXPECT_EQ(complaintOf([this] {
              open({{{}, {}, {}}});
            }),
            "calibrations of 3 slices, allowed: at most 2, as many as the device has");
  SliceCalibration bad = someCalibration();
  bad.max_volts = 0.0;
  EXPECT_EQ(complaintOf([&] {
              open({{{}, bad}});
            }),
            "max_volts of slice 1 = 0 V is out of range, allowed: above 0...1000 V");
  open({});
  EXPECT_THROW(driver_->set(0, bad), Exception);
  EXPECT_THROW(driver_->set(2, someCalibration()), Exception);
  EXPECT_EQ(driver_->uncalibrated(), 3U);
  script_.is_raw = false;
  EXPECT_EQ(complaintOf([this] { open({}); }),
            "a calibration of a device that speaks metres and newtons already");
}

}  // namespace
}  // namespace ergotic::tgr
