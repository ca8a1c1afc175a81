// SPDX-License-Identifier: BSD-3-Clause
#include "support/test.hpp"
#include "tgr/driver_rigs.hpp"
#include "tgr/scripted_driver.hpp"

/// The small push that tells sign and scale of a slice before there is force.

namespace ergotic::tgr {
namespace {

constexpr double kZeroVolts = 0.003;

SliceCalibration pushedCalibration() {
  SliceCalibration c = test::someCalibration();
  c.zero_volts = kZeroVolts;
  c.max_volts = 10.0;
  return c;
}

class PushTest : public ::testing::Test {
 protected:
  PushTest() {
    script_.is_raw = true;
    driver_ = makeCalibratedDriver(std::make_unique<test::ScriptedDevice>(script_),
                                   {{pushedCalibration(), {}}});
    driver_->open(1000.0);
  }
  void exchange() { driver_->exchange(forces_.data(), positions_.data()); }

  test::Script script_;
  std::unique_ptr<CalibratedDriver> driver_;
  std::array<double, 2> forces_{};
  std::array<double, 2> positions_{};
};

constexpr double kSliceKg = 0.3;
constexpr double kTickS = 1e-3;

/// A slice whose amplifier gives so many times the force that it should, under a push.
struct PushedSlice {
  double times = 1.0;
  double strongest_n = 0.0;  // that its amplifier gave
  double v = 0.0;
  double x = 0.0;

  Push push(CalibratedDriver& driver, test::Script& script, double newtons) {
    const SliceCalibration c = pushedCalibration();
    const std::array<double, 2> forces{};
    std::array<double, 2> positions{};
    driver.push(0, newtons);
    for (int tick = 0; tick < 200; ++tick) {
      script.positions[0] = c.rest_volts + x / c.metres_per_volt;
      driver.exchange(forces.data(), positions.data());
      const double force = times * (script.forces[0] - c.zero_volts) / c.volts_per_newton;
      strongest_n = std::max(strongest_n, std::abs(force));
      x += v * kTickS + force / kSliceKg * kTickS * kTickS / 2.0;
      v += force / kSliceKg * kTickS;
    }
    EXPECT_EQ(script.forces[0], c.zero_volts) << "it is over";
    return driver.takePush().value_or(Push{});
  }
};

TEST_F(PushTest, TellsSignAndScaleByAPush) {
  PushedSlice good;
  EXPECT_NEAR(judgePush(good.push(*driver_, script_, kPushN), kSliceKg), 1.0, 0.01);
  EXPECT_LE(good.strongest_n, kPushN);
  EXPECT_FALSE(driver_->takePush().has_value()) << "once";
  const auto complaintAt = [&](double times) {
    PushedSlice slice{times};
    return complaintOf([&] { judgePush(slice.push(*driver_, script_, kPushN), kSliceKg); });
  };
  EXPECT_THAT(complaintAt(-1.0), HasSubstr("the sign of volts_per_newton"));
  EXPECT_THAT(complaintAt(-10.0), HasSubstr("the sign of volts_per_newton"));
  for (const double times : {10.0, 0.1, 0.0}) {
    EXPECT_THAT(complaintAt(times), HasSubstr("volts_per_newton is wrong")) << times;
  }
  for (const double times : {2.0, 0.5}) {
    EXPECT_EQ(complaintAt(times), "") << times;
  }
  EXPECT_THAT(complaintOf([&] { driver_->push(1, kPushN); }), HasSubstr("has no calibration"));
  EXPECT_THAT(complaintOf([&] { driver_->push(2, kPushN); }), HasSubstr("slice to push"));
  for (const double newtons : {0.0, -1.0, 1.1, std::nan("")}) {
    EXPECT_THAT(complaintOf([&] { driver_->push(0, newtons); }), HasSubstr("allowed 0.1...1"));
  }
}

TEST_F(PushTest, IsWeakWhereTheGainIsTooLarge) {
  for (const auto& [times, most_n] : {std::pair(10.0, 5.0), std::pair(50.0, 15.0)}) {
    PushedSlice slice{times};
    slice.push(*driver_, script_, kPushN);
    EXPECT_LT(slice.strongest_n, most_n) << "of " << times << " N";
    EXPECT_LT(slice.v, 0.35);
  }
}

/// The push of slice 0 has gone on for some ticks.
class PushUnderWayTest : public PushTest {
 protected:
  PushUnderWayTest() {
    script_.positions = {2.0, 0.0};
    driver_->push(0, kPushN);
    for (int i = 0; i < 100; ++i) {
      exchange();
      EXPECT_EQ(script_.forces[0], kZeroVolts) << "does the slice rest?";
    }
    for (int i = 0; i < 10; ++i) {
      exchange();
    }
    EXPECT_NEAR(script_.forces[0], kZeroVolts - 0.05 * 9.5 / 50.0, 1e-12);
    EXPECT_FALSE(driver_->takePush().has_value());
  }
  void expectNoForceAnyMore() {
    for (int i = 0; i < 100; ++i) {
      exchange();
      ASSERT_EQ(script_.forces[0], kZeroVolts) << i;
    }
  }
  void expectToldNothing() {
    EXPECT_THAT(complaintOf([&] { judgePush(driver_->takePush().value(), kSliceKg); }),
                HasSubstr("ended before it told anything"));
  }
};

TEST_F(PushUnderWayTest, EndsWhenTheDeviceIsMadeSafe) {
  script_.flags = kMadeSafe;
  exchange();
  script_.flags = 0;
  expectNoForceAnyMore();
  expectToldNothing();
}

TEST_F(PushUnderWayTest, EndsWhenTheDeviceIsLost) {
  script_.flags = kDeviceLost;
  exchange();
  script_.flags = 0;
  expectNoForceAnyMore();
  expectToldNothing();
}

TEST_F(PushUnderWayTest, EndsWhenTheSensorIsAtItsRail) {
  script_.positions[0] = 8.0;
  exchange();
  expectNoForceAnyMore();
  expectToldNothing();
}

TEST_F(PushUnderWayTest, EndsBeforeAForceOfTheModel) {
  forces_[0] = 3.0;
  exchange();
  EXPECT_NEAR(script_.forces[0], kZeroVolts - 0.15, 1e-12);
  forces_[0] = 0.0;
  expectNoForceAnyMore();
  expectToldNothing();
}

TEST_F(PushTest, IsNotMadeWhereTheSliceMovesAnyway) {
  driver_->push(0, kPushN);
  for (int i = 0; i < 200; ++i) {
    script_.positions[0] = 2.0 + kZeroVolts * i * kTickS / 0.005;  // 3 mm/s
    exchange();
    ASSERT_EQ(script_.forces[0], kZeroVolts);
  }
  EXPECT_THAT(complaintOf([&] { judgePush(driver_->takePush().value(), kSliceKg); }),
              HasSubstr("mm before it was pushed"));
}

TEST_F(PushUnderWayTest, EndsWhenItIsToldTo) {
  driver_->endPush();
  expectNoForceAnyMore();
  EXPECT_FALSE(driver_->takePush().has_value());
}

TEST_F(PushUnderWayTest, EndsByItselfWhereNothingMoves) {
  for (int i = 0; i < 41; ++i) {  // one tick until a position shows the first force
    exchange();
  }
  EXPECT_NEAR(script_.forces[0], kZeroVolts - 0.05, 1e-12);
  expectNoForceAnyMore();
  const Push push = driver_->takePush().value();
  EXPECT_DOUBLE_EQ(push.seconds, kPushS);
  EXPECT_THAT(complaintOf([&] { judgePush(push, kSliceKg); }), HasSubstr("a hand holds the slice"));
}

TEST_F(PushUnderWayTest, BeginsAnewWithAnother) {
  driver_->push(0, kPushN);
  for (int i = 0; i < 101; ++i) {
    EXPECT_NEAR(script_.forces[0], i == 0 ? kZeroVolts - 0.05 * 9.5 / 50.0 : kZeroVolts, 1e-12);
    exchange();
  }
  EXPECT_NEAR(script_.forces[0], kZeroVolts - 0.05 * 0.5 / 50.0, 1e-12);
}

/// What a calibration says of a virtual slice of the usual mechanics, with a hand at it.
class PushedVirtualSliceTest : public ::testing::TestWithParam<double> {
 protected:
  /// \param times  the slice's force over what the calibration says
  std::string complaintAt(double times) {
    VirtualDriverConfig config;
    config.slices = 1;
    config.slice.hand_damping = 5.0;  // held loosely
    config.slice.volts = pushedCalibration();
    config.slice.volts->zero_volts = 0.0;
    SliceCalibration believed = *config.slice.volts;
    believed.volts_per_newton *= times;
    const auto driver = makeCalibratedDriver(makeVirtualDriver(config), {{believed}});
    driver->open(GetParam());
    const double forces = 0.0;
    double position = 0.0;
    driver->push(0, kPushN);
    for (int i = 0; i < GetParam(); ++i) {
      driver->exchange(&forces, &position);
    }
    return complaintOf([&] { judgePush(driver->takePush().value(), config.slice.mass); });
  }
};

TEST_P(PushedVirtualSliceTest, IsWellOnlyWithTheGainThatItHas) {
  for (const double times : {0.7, 1.0, 2.0}) {
    EXPECT_EQ(complaintAt(times), "") << times;
  }
  for (const double times : {0.1, 10.0, 100.0}) {
    EXPECT_THAT(complaintAt(times), HasSubstr("volts_per_newton is wrong")) << times;
  }
  for (const double times : {-1.0, -10.0}) {
    EXPECT_THAT(complaintAt(times), HasSubstr("the sign of volts_per_newton")) << times;
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, PushedVirtualSliceTest, ::testing::Values(1050.0, 3150.0, 10000.0));

}  // namespace
}  // namespace ergotic::tgr
