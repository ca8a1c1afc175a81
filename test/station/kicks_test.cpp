// SPDX-License-Identifier: BSD-3-Clause
// Force that goes and comes back with every stall is a hand that is kicked.
#include "ergotic/station/station.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

using test::Bench;
using test::kRampTicks;

class KicksTest : public ::testing::Test {
 protected:
  /// So many stalls of four ticks in `seconds`, evenly spaced, until one is a fault.
  /// \return how many there were
  int stall(double per_second, double seconds) {
    const auto apart =
        static_cast<std::int64_t>(bench_.station->config().rates.gesturalHz() / per_second);
    const int most = static_cast<int>(per_second * seconds);
    for (int n = 1; n <= most; ++n) {
      bench_.run(apart - 4);
      bench_.station->catchUp(4, 1'200'000);
      if (test::count(bench_.events(), Event::Type::kFault) > 0) {
        return n;
      }
    }
    return most;
  }
  bool hasForce() {
    bench_.run(kRampTicks);
    return bench_.log.forces[0] != 0.0;
  }

  Bench bench_;
};

TEST_F(KicksTest, AreAFaultWhenTheyComeTenTimesASecond) {
  bench_.engage();
  EXPECT_LE(stall(10.0, 10.0), 10);
  EXPECT_FALSE(hasForce());
}

TEST_F(KicksTest, AreAFaultWhenTheyComeSixTimesASecond) {
  bench_.engage();
  EXPECT_LE(stall(6.0, 180.0), 12);
}

TEST_F(KicksTest, MayComeNowAndThen) {
  bench_.engage();
  EXPECT_EQ(stall(1.0, 60.0), 60);
  EXPECT_TRUE(hasForce());
}

TEST_F(KicksTest, AreForgottenAfterASecondEach) {
  bench_.engage();
  for (int n = 0; n < 5; ++n) {
    EXPECT_EQ(stall(1000.0, 0.003), 3) << "as many as may come at once";
    bench_.run(static_cast<std::int64_t>(bench_.station->config().rates.gesturalHz()));
  }
  EXPECT_TRUE(hasForce());
}

TEST_F(KicksTest, AreNoneWithoutForce) {
  EXPECT_EQ(stall(10.0, 10.0), 100);
  bench_.engage();
  EXPECT_TRUE(hasForce()) << "and none is owed";
}

TEST_F(KicksTest, AreAsManyAsTheSettingSays) {
  StationConfig config = Bench::quickConfig();
  config.max_stalls = 20;
  Bench patient(
      {}, [](std::int64_t, int) { return 0.01; }, config);
  patient.engage();
  for (int n = 0; n < 20; ++n) {
    patient.station->catchUp(4, 1'200'000);
  }
  EXPECT_EQ(test::count(patient.events(), Event::Type::kFault), 0);
  patient.station->catchUp(4, 1'200'000);
  const Event fault = test::firstOf(patient.events(), Event::Type::kFault);
  EXPECT_EQ(fault.index, static_cast<int>(FaultReason::kStall));
  EXPECT_DOUBLE_EQ(fault.value, 1.2e-3);
  EXPECT_EQ(fault.id, 20U) << "one more than that";
}

TEST_F(KicksTest, AreWhatModelsAreThatKeepForceUntilTheNextOneMayNot) {
  bench_.engage();
  for (int n = 0; n < 3; ++n) {
    ASSERT_TRUE(bench_.swap(test::makeSpring()));
    bench_.run(200);
  }
  EXPECT_EQ(bench_.interlock->read().state, ForceState::kPlaying);
  ASSERT_TRUE(bench_.swap(test::makeSpring()));
  bench_.run(200);
  EXPECT_EQ(bench_.interlock->read().state, ForceState::kReady) << "no fault: it waits";
  const auto events = bench_.events();
  EXPECT_EQ(test::count(events, Event::Type::kFault), 0);
  EXPECT_EQ(test::count(events, Event::Type::kStopped), 1);
  for (int n = 0; n < 20; ++n) {
    ASSERT_TRUE(bench_.swap(test::makeSpring()));
    bench_.run(200);
  }
  bench_.engage();
  EXPECT_TRUE(hasForce()) << "without force nobody is kicked";
}

TEST_F(KicksTest, AreWhatASensorMakesThatStandsStillAgainAndAgain) {
  std::int64_t still = 0;
  const auto hand = [&still](std::int64_t tick, int) {
    const double to_and_fro = tick % 2 == 0 ? 1e-6 : -1e-6;
    return 0.03 + (tick % 300 < still ? 0.0 : to_and_fro);
  };
  StationConfig config = Bench::quickConfig();
  config.safety.frozen_s = 0.1;
  Bench bench({}, hand, config);
  bench.engage();
  const double whole = bench.log.forces[0];
  ASSERT_GT(std::abs(whole), 0.05 * config.safety.force_limit_n);
  still = 60;  // of 300 ticks: ten times a second for 20 ms
  bench.run(900);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kFault), 0) << "three are none";
  bench.run(900);
  const Event fault = test::firstOf(bench.events(), Event::Type::kFault);
  EXPECT_EQ(fault.index, static_cast<int>(FaultReason::kFrozen));
  EXPECT_EQ(fault.value, 0.0) << "of slice 0";
}

TEST_F(KicksTest, AreForgottenByWhoLoadsAModelOnceASecond) {
  bench_.engage();
  const auto second = static_cast<std::int64_t>(bench_.station->config().rates.gesturalHz());
  for (int n = 0; n < 20; ++n) {
    ASSERT_TRUE(bench_.swap(test::makeSpring()));
    bench_.run(second);
    bench_.events();
  }
  EXPECT_TRUE(hasForce());
}

TEST_F(KicksTest, AreWhatAThreadMakesThatDoesNotFinishItsShare) {
  bench_.engage();
  const double whole = bench_.log.forces[0];
  bench_.instrument->held_up = true;
  bench_.run(2);
  EXPECT_EQ(bench_.log.forces[0], 0.0) << "one tick later at the most";
  bench_.run(10);
  bench_.instrument->held_up = false;
  bench_.run(3);
  EXPECT_LT(std::abs(bench_.log.forces[0]), 0.2 * std::abs(whole)) << "it comes back in a ramp";
  bench_.run(kRampTicks);
  EXPECT_EQ(bench_.log.forces[0], whole);
  for (int n = 0; n < 3; ++n) {
    bench_.instrument->held_up = true;
    bench_.run(1);
    bench_.instrument->held_up = false;
    bench_.run(5);
  }
  EXPECT_EQ(test::firstOf(bench_.events(), Event::Type::kFault).index,
            static_cast<int>(FaultReason::kStall));
}

}  // namespace
}  // namespace ergotic::station
