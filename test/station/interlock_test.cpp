// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/interlock.hpp"

#include "ergotic/station/station.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

using test::Bench;
using test::kRampTicks;

TEST(InterlockTest, LetsForceBackOnlyForWhoAskedAfterTheLastStop) {
  Interlock interlock;
  const Ticket before = interlock.ticket();
  interlock.stop();
  EXPECT_FALSE(interlock.engage(before));
  EXPECT_FALSE(interlock.read().isOpen());
  EXPECT_TRUE(interlock.engage(interlock.ticket()));
  EXPECT_TRUE(interlock.play());
  EXPECT_EQ(interlock.read().state, ForceState::kPlaying);
  EXPECT_FALSE(interlock.play()) << "once";
}

TEST(InterlockTest, KeepsTheFirstReasonUntilARecoveryThatWasAskedForLater) {
  Interlock interlock;
  interlock.latch(FaultReason::kWatchdog);
  const Ticket between = interlock.ticket();
  interlock.latch(FaultReason::kEmergencyStop);
  EXPECT_EQ(interlock.read().reason, FaultReason::kWatchdog);
  EXPECT_FALSE(interlock.recover(between));
  EXPECT_FALSE(interlock.engage(interlock.ticket())) << "recover comes first";
  EXPECT_TRUE(interlock.recover(interlock.ticket()));
  EXPECT_EQ(interlock.read().state, ForceState::kReady);
  EXPECT_EQ(interlock.read().reason, FaultReason::kNone);
}

TEST(InterlockTest, NeitherStopNorCalibrationEndsAFault) {
  Interlock interlock;
  interlock.latch(FaultReason::kEmergencyStop);
  interlock.stop();
  interlock.setCalibrated(false);
  interlock.setCalibrated(true);
  EXPECT_TRUE(interlock.read().isLatched());
}

TEST(InterlockTest, TakesForceFromASliceThatLostItsCalibration) {
  Interlock interlock;
  const Ticket asked = interlock.ticket();
  ASSERT_TRUE(interlock.engage(asked));
  interlock.setCalibrated(false);
  EXPECT_EQ(interlock.read().state, ForceState::kUncalibrated);
  EXPECT_FALSE(interlock.engage(interlock.ticket()));
  interlock.setCalibrated(true);
  EXPECT_EQ(interlock.read().state, ForceState::kReady);
  EXPECT_FALSE(interlock.engage(asked)) << "force never comes back by itself";
}

TEST(InterlockTest, AnEmergencyStopDuringARecoveryHolds) {
  Bench bench;
  bench.station->makeSafe(FaultReason::kWatchdog);
  bench.run(1);
  bench.command(Command::Type::kRecover);
  bench.command(Command::Type::kEngage);
  bench.station->makeSafe(FaultReason::kEmergencyStop);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_TRUE(bench.log.safe.load()) << "the driver's latch, too";
  const auto events = bench.events();
  EXPECT_EQ(test::count(events, Event::Type::kRecovered), 0);
  EXPECT_EQ(test::firstOf(events, Event::Type::kRefused).index,
            static_cast<int>(Refusal::kOutdated));
  bench.command(Command::Type::kRecover);
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0) << "asked for later";
}

TEST(InterlockTest, AnEmergencyStopWhileTheDriverIsSetFreeHolds) {
  Bench bench;
  bench.station->makeSafe(FaultReason::kWatchdog);
  const Ticket asked = bench.interlock->ticket();
  bench.station->makeSafe(FaultReason::kEmergencyStop);
  Command recover;
  recover.type = Command::Type::kRecover;
  recover.asked = asked;
  ASSERT_TRUE(bench.station->submit(recover));
  EXPECT_TRUE(bench.log.safe.load());
}

TEST(InterlockTest, AnEmergencyStopBeforeTheFirstStationHolds) {
  auto interlock = std::make_shared<Interlock>();
  const Ticket autoengage = interlock->ticket();
  interlock->latch(FaultReason::kEmergencyStop);
  Bench bench;
  bench.station = std::make_unique<Station>(
      Bench::quickConfig(),
      std::make_unique<test::ScriptedDriver>(2, bench.log, [](std::int64_t, int) { return 0.01; }),
      test::makeSpring(), interlock);
  Command engage;
  engage.type = Command::Type::kEngage;
  engage.asked = autoengage;
  ASSERT_TRUE(bench.station->submit(engage));
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kFault).index,
            static_cast<int>(FaultReason::kEmergencyStop));
}

TEST(InterlockTest, AnEngageThatWasAskedForBeforeAStopBringsNoForce) {
  Bench bench;
  bench.command(Command::Type::kEngage);
  bench.station->stop();
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kRefused).index,
            static_cast<int>(Refusal::kOutdated));
}

TEST(InterlockTest, AnAnswerSaysWhichRequestItAnswers) {
  Bench bench;
  Command command;
  command.type = Command::Type::kEngage;
  command.id = 7;
  bench.station->submit(command);
  bench.run(1);
  bench.station->makeSafe();
  bench.run(1);
  command.id = 8;
  bench.station->submit(command);
  command.type = Command::Type::kRecover;
  command.id = 9;
  bench.station->submit(command);
  bench.run(1);
  const auto events = bench.events();
  EXPECT_EQ(test::firstOf(events, Event::Type::kEngaged).id, 7U);
  EXPECT_EQ(test::firstOf(events, Event::Type::kRefused).id, 8U);
  EXPECT_EQ(test::firstOf(events, Event::Type::kRecovered).id, 9U);
}

TEST(InterlockTest, AModelThatTakesForceWithItLeavesNoneBehind) {
  Bench bench;
  bench.engage();
  ASSERT_TRUE(bench.swap(test::makeSpring(), SwapForce::kNever));
  bench.run(1000);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_EQ(bench.interlock->read().state, ForceState::kReady);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kSwapped).value, 1.0);
  ASSERT_TRUE(bench.swap(test::makeSpring()));
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0) << "the next one does not";
}

// What counts is who let force out when the new model plays, not when it was handed over.
TEST(InterlockTest, AModelOfAnotherTakesForceHoweverItMeetsAnEngage) {
  constexpr Caller kPlayer = 1;
  constexpr Caller kOther = 2;
  for (int between = 0; between < 40; ++between) {
    for (const Caller loader : {kPlayer, kOther}) {
      Bench bench;
      bench.engage(kOther);
      bench.station->stop();
      bench.run(10);
      ASSERT_TRUE(bench.swap(test::makeSpring(), SwapForce::kCaller, loader));
      bench.run(between);
      bench.engage(kPlayer);
      bench.run(1000);
      const Event swapped = test::firstOf(bench.events(), Event::Type::kSwapped);
      const bool was_before = between >= bench.station->swapDelayTicks();
      const bool keeps = was_before || loader == kPlayer;
      EXPECT_EQ(swapped.value, keeps ? 0.0 : 1.0) << between << " ticks before, by " << loader;
      EXPECT_EQ(bench.log.forces[0], keeps ? -1.0 : 0.0) << between;
    }
  }
}

}  // namespace
}  // namespace ergotic::station
