// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/station.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

/// What takes the force from the hand beside the safety chain.

namespace ergotic::station {
namespace {

using test::Bench;
using test::kRampTicks;

constexpr double kHandM = 0.01;

StationConfig withPresence(double seconds) {
  StationConfig config = Bench::quickConfig();
  config.presence_s = seconds;
  return config;
}

StationConfig withInjection() {
  StationConfig config = Bench::quickConfig();
  config.allow_fault_injection = true;
  const tgr::SafetyConfig usual;
  config.safety.energy_limit_j = usual.energy_limit_j;
  config.safety.energy_supply_w = usual.energy_supply_w;
  return config;
}

double still(std::int64_t /*exchange*/, int /*slice*/) {
  return kHandM;
}

void tellPresence(Bench& bench, bool present) {
  bench.station->tellPresence(present);
}

FaultReason faultOf(Bench& bench) {
  return static_cast<FaultReason>(test::firstOf(bench.events(), Event::Type::kFault).index);
}

ForceState stateOf(Bench& bench) {
  bench.run(60);  // a snapshot comes 60 times a second
  const Snapshot* snapshot = bench.station->snapshot();
  return snapshot != nullptr ? snapshot->state : ForceState::kDisconnected;
}

TEST(CalibrationGuardTest, ForceNeedsEverySliceInUseToBeCalibrated) {
  Bench bench;
  bench.driver->uncalibrated_slices = 0b01;  // the port's slice
  EXPECT_EQ(stateOf(bench), ForceState::kUncalibrated);
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kRefused).index,
            static_cast<int>(Refusal::kUncalibrated));
  bench.driver->uncalibrated_slices = 0b10;  // one that moves nothing
  EXPECT_EQ(stateOf(bench), ForceState::kReady);
  bench.run(kRampTicks);  // the port interpolated to where the hand is
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0);
}

TEST(CalibrationGuardTest, AFirstCalibrationLetsThePortGlideToWhereTheHandIs) {
  bool calibrated = false;
  Bench bench({}, [&](std::int64_t, int) { return calibrated ? 0.02 : 0.0; });
  bench.driver->uncalibrated_slices = 0b01;
  bench.run(10);
  calibrated = true;
  bench.driver->uncalibrated_slices = 0;
  bench.run(400);
  const std::vector<GestureTick> ticks = bench.recorded();
  ASSERT_EQ(ticks.size(), 410U);
  double largest = 0.0;
  for (std::size_t n = 1; n < 410; ++n) {
    largest = std::max(largest, std::abs(ticks[n].port[0] - ticks[n - 1].port[0]));
  }
  EXPECT_LE(largest, 0.02 / 314.0) << "0.1 s at 3150 Hz";
  EXPECT_EQ(ticks[409].port[0], 0.02);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kFault), 0);
}

// Its driver says for one tick that it has none (tgr::CalibratedDriver).
TEST(CalibrationGuardTest, AnotherCalibrationOfASliceFarFromItsRestIsNoJump) {
  StationConfig config = Bench::quickConfig();
  config.safety.max_speed_m_per_s = tgr::SafetyConfig().max_speed_m_per_s;
  bool is_away = false;
  Bench bench(
      {}, [&](std::int64_t, int) { return is_away ? 0.0 : 0.02; }, config);
  bench.run(10);
  is_away = true;
  bench.driver->uncalibrated_slices = 0b01;
  bench.run(1);
  is_away = false;
  bench.driver->uncalibrated_slices = 0;
  bench.run(400);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kFault), 0);
  EXPECT_EQ(bench.recorded().back().port[0], 0.02);
}

TEST(CalibrationGuardTest, LosingACalibrationTakesTheForceAtOnceAndForGood) {
  Bench bench;
  bench.engage();
  bench.driver->uncalibrated_slices = 0b01;
  bench.run(2);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  bench.driver->uncalibrated_slices = 0;
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0) << "engage is needed again";
}

TEST(PresenceGuardTest, ForceNeedsTheSwitchToBeHeld) {
  Bench bench({}, still, withPresence(0.2));
  bench.command(Command::Type::kEngage);
  bench.run(2);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kRefused).index,
            static_cast<int>(Refusal::kPresence));
  tellPresence(bench, true);
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0);
}

TEST(PresenceGuardTest, LettingGoIsAFaultThatStays) {
  Bench bench({}, still, withPresence(0.2));
  tellPresence(bench, true);
  bench.engage();
  tellPresence(bench, false);
  bench.run(2);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_EQ(faultOf(bench), FaultReason::kPresence);
  tellPresence(bench, true);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0);
}

TEST(PresenceGuardTest, LettingGoForLessThanATickIsLettingGo) {
  Bench bench({}, still, withPresence(0.2));
  tellPresence(bench, true);
  bench.engage();
  tellPresence(bench, false);
  tellPresence(bench, true);
  bench.run(1);
  EXPECT_EQ(faultOf(bench), FaultReason::kPresence);
}

TEST(PresenceGuardTest, ASwitchThatIsNotToldAnyMoreIsLetGo) {
  Bench bench({}, still, withPresence(0.2));  // 630 ticks
  tellPresence(bench, true);
  bench.command(Command::Type::kEngage);
  bench.run(631);  // the first one heard it
  EXPECT_EQ(bench.log.forces[0], -1.0);
  bench.run(1);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_EQ(faultOf(bench), FaultReason::kPresence);
}

/// What the zero of the next exchange may not reach.
TEST(DeviceGuardTest, ADeviceThatIsLostOrTakesNoForceIsMadeSafeInTheSameTick) {
  for (const std::uint32_t met : {tgr::kDeviceLost, tgr::kWriteFailed}) {
    Bench bench;
    bench.engage();
    EXPECT_FALSE(bench.log.safe);
    bench.driver->flags_of = [met](std::int64_t) { return met; };
    for (int n = 0; n < 400 && bench.interlock->read().isOpen(); ++n) {
      bench.run(1);
    }
    EXPECT_TRUE(bench.interlock->read().isLatched()) << met;
    EXPECT_TRUE(bench.log.safe) << met;
  }
}

TEST(DeviceGuardTest, OfADeclaredDampingHalfIsReliedOn) {
  EXPECT_EQ(trustedDamping(0.0), 0.0);
  EXPECT_EQ(trustedDamping(3.0), 1.5);
  EXPECT_EQ(trustedDamping(1000.0), 100.0);
}

class InjectionTest : public testing::TestWithParam<InjectedModelFault> {
 protected:
  static void inject(Bench& bench, double ticks) {
    ASSERT_TRUE(bench.command(Command::Type::kInject, ticks, static_cast<int>(GetParam())));
  }
  /// A hand that gives way to the force of a spring of negative stiffness.
  static double giving(std::int64_t n, int /*slice*/) {
    return n < kRampTicks ? kHandM : kHandM + 5e-5 * static_cast<double>(n - kRampTicks);
  }
};

TEST_P(InjectionTest, DoesNothingUnlessItIsAllowed) {
  Bench bench;
  bench.engage();
  inject(bench, 100.0);
  bench.run(100);
  EXPECT_EQ(bench.log.forces[0], -1.0);
}

TEST_P(InjectionTest, GoesAfterItsTicks) {
  Bench bench({}, still, withInjection());
  inject(bench, 1.0);
  bench.run(2);
  bench.command(Command::Type::kRecover);
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0);
}

TEST_P(InjectionTest, IsAFaultThatTakesTheForce) {
  Bench bench({}, giving, withInjection());
  bench.engage();
  inject(bench, 1e6);
  bench.run(1000);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  const FaultReason reason = faultOf(bench);
  EXPECT_EQ(reason, GetParam() == InjectedModelFault::kActive ? FaultReason::kEnergy
                                                              : FaultReason::kModelBlowUp);
}

INSTANTIATE_TEST_SUITE_P(All,
                         InjectionTest,
                         testing::Values(InjectedModelFault::kNotANumber,
                                         InjectedModelFault::kBlowUp,
                                         InjectedModelFault::kActive));

}  // namespace
}  // namespace ergotic::station
