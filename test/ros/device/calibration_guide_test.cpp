// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/calibration_guide.hpp"

#include "support/test.hpp"

namespace ergotic::node {
namespace {

/// Two slices that speak volts; the sensor of each says what the test wants.
class RawDevice : public tgr::CalibratedDriver {
 public:
  void open(double /*tick_rate_hz*/) override {}
  void close() noexcept override {}
  int slices() const noexcept override { return 2; }
  std::uint32_t exchange(const double* /*forces*/, double* /*positions*/) noexcept override {
    return tgr::kExchangeOk;
  }
  void makeSafe() noexcept override {}
  void rearm() noexcept override {}
  void set(int slice, const tgr::SliceCalibration& calibration) override {
    calibration_.slices.at(static_cast<std::size_t>(slice)) = calibration;
  }
  const tgr::Calibration& calibration() const noexcept override { return calibration_; }
  void push(int slice, double newtons) override {
    pushed_ = slice;
    newtons_ = newtons;
  }
  void endPush() noexcept override { pushed_ = -1; }
  std::optional<tgr::Push> takePush() noexcept override { return push_; }
  void readVolts(double* volts) noexcept override {
    noise_ = -noise_;
    volts[0] = 0.0;
    volts[1] = volts_ + noise_;
  }

  double volts_ = 0.0;
  double noise_ = 0.001;
  int pushed_ = -1;
  double newtons_ = 0.0;
  std::optional<tgr::Push> push_;

 private:
  tgr::Calibration calibration_{std::vector<tgr::SliceCalibration>(2)};
};

class CalibrationGuideTest : public ::testing::Test {
 protected:
  CalibrationGuideTest() { raw_parts_.push_back({0, 0, &device_}); }
  void begin(int slice) { guide_.begin(raw_parts_, 2, slice); }

  tgr::CalibrationPoint sampleAt(double position_m) {
    guide_.sample(position_m);
    std::optional<tgr::CalibrationPoint> point;
    for (int i = 0; i < CalibrationGuide::kReadings; ++i) {
      EXPECT_FALSE(point) << i;
      point = guide_.poll();
    }
    return point.value();
  }

  RawDevice device_;
  std::vector<tgr::DriverStack::Part> raw_parts_;
  CalibrationGuide guide_;
};

TEST_F(CalibrationGuideTest, ChecksSignAndScaleByAPush) {
  constexpr double kMassKg = 0.3;
  const auto check = [&] {
    begin(1);
    guide_.push(0.5);
  };
  const auto slice = [&] { return device_.calibration().slices[1]; };
  tgr::SliceCalibration calibration;
  calibration.is_calibrated = true;
  calibration.metres_per_volt = 0.005;
  calibration.volts_per_newton = 0.05;
  device_.set(1, calibration);
  EXPECT_THAT(complaintOf([&] { guide_.push(0.5); }), HasSubstr("begin first"));
  EXPECT_THAT(complaintOf(check), HasSubstr("full_scale_newtons of slice 1 is not in"));
  EXPECT_FALSE(guide_.isUnderWay());
  EXPECT_EQ(device_.pushed_, -1);
  calibration.full_scale_newtons = 200.0;
  device_.set(1, calibration);

  check();
  EXPECT_EQ(device_.pushed_, 1);
  EXPECT_EQ(device_.newtons_, 0.5);
  EXPECT_FALSE(guide_.pollPush(kMassKg).has_value()) << "under way";
  EXPECT_THAT(complaintOf([&] { guide_.sample(0.0); }), HasSubstr("begin first"));
  EXPECT_THAT(complaintOf(check), HasSubstr("is being calibrated"));
  device_.push_ = tgr::Push{0.5, 0.001, 0.05};
  EXPECT_NEAR(guide_.pollPush(kMassKg).value(), 0.72, 1e-9);
  EXPECT_FALSE(guide_.isUnderWay());
  EXPECT_TRUE(isChecked(slice()));

  check();
  device_.push_ = tgr::Push{0.5, -0.001, 0.05};
  EXPECT_THAT(complaintOf([&] { guide_.pollPush(kMassKg); }), HasSubstr("sign"));
  EXPECT_FALSE(guide_.isUnderWay());
  EXPECT_FALSE(isChecked(slice())) << "it was well before";
}

TEST_F(CalibrationGuideTest, EndsAPushWhenItIsAborted) {
  tgr::SliceCalibration calibration;
  calibration.is_calibrated = true;
  calibration.full_scale_newtons = 200.0;
  device_.set(1, calibration);
  begin(1);
  guide_.push(1.0);
  EXPECT_TRUE(guide_.isPushing());
  guide_.abort();
  EXPECT_EQ(device_.pushed_, -1);
  EXPECT_FALSE(guide_.isPushing());
  EXPECT_FALSE(guide_.isUnderWay());
}

TEST_F(CalibrationGuideTest, FitsALineThroughPlacesAndVolts) {
  begin(1);
  for (const double place : {-0.02, 0.01, 0.02}) {
    device_.volts_ = 2.0 + place / 0.005;
    const tgr::CalibrationPoint point = sampleAt(place);
    EXPECT_EQ(point.position_m, place);
    EXPECT_NEAR(point.mean_volts, device_.volts_, 1e-12);
    EXPECT_NEAR(point.rms_volts, 0.001, 1e-12);
  }
  const tgr::SliceCalibration fitted = guide_.finish(1e-4, 0.05);
  EXPECT_NEAR(fitted.metres_per_volt, 0.005, 1e-12);
  EXPECT_NEAR(fitted.rest_volts, 2.0, 1e-9);
  EXPECT_EQ(fitted.volts_per_newton, 0.05);
  EXPECT_EQ(device_.calibration().slices[1].metres_per_volt, fitted.metres_per_volt);
  EXPECT_FALSE(device_.calibration().slices[0].is_calibrated);
  EXPECT_FALSE(guide_.isUnderWay());
}

TEST_F(CalibrationGuideTest, GoesOnWhenTheFitIsNotGoodEnough) {
  begin(1);
  for (const double place : {-0.02, 0.0, 0.02}) {
    device_.volts_ = std::abs(place) / 0.005 + place;  // not a line
    sampleAt(place);
  }
  EXPECT_NE(complaintOf([this] { guide_.finish(1e-4, 0.05); }), "");
  EXPECT_TRUE(guide_.isUnderWay());
  EXPECT_EQ(guide_.samples(), 3U);
  EXPECT_FALSE(device_.calibration().slices[1].is_calibrated);
}

TEST_F(CalibrationGuideTest, ForgetsItsSamplesWhenItIsAborted) {
  begin(1);
  sampleAt(0.0);
  guide_.abort();
  EXPECT_FALSE(guide_.isUnderWay());
  begin(1);
  EXPECT_EQ(guide_.samples(), 0U);
}

TEST_F(CalibrationGuideTest, SaysWhatIsWrongWithAStep) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(complaintOf([this] { guide_.sample(0.0); }), HasSubstr("begin first"));
  EXPECT_THAT(complaintOf([this] { guide_.finish(1e-4, 0.0); }), HasSubstr("begin first"));
  EXPECT_THAT(complaintOf([this] { begin(2); }), HasSubstr("allowed: 0...1"));
  EXPECT_THAT(complaintOf([this] { begin(-1); }), HasSubstr("allowed: 0...1"));
  begin(1);
  EXPECT_THAT(complaintOf([this] { begin(0); }), HasSubstr("slice 1"));
  EXPECT_THAT(complaintOf([=] { guide_.sample(nan); }), HasSubstr("allowed: -1...1"));
  guide_.sample(0.0);
  EXPECT_THAT(complaintOf([this] { guide_.sample(0.0); }), HasSubstr("under way"));
  EXPECT_THAT(complaintOf([this] { guide_.finish(1e-4, 0.0); }), HasSubstr("under way"));
}

TEST_F(CalibrationGuideTest, HasNothingToDoWithDevicesThatSpeakMetres) {
  raw_parts_.clear();
  EXPECT_THAT(complaintOf([this] { begin(1); }), HasSubstr("speaks metres"));
}

}  // namespace
}  // namespace ergotic::node
