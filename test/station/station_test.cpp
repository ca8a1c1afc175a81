// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/station.hpp"

#include "ergotic/station/timer_source.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

using test::Bench;
using test::kRampTicks;
using test::SpringInstrument;

constexpr double kStiffness = 100.0;

/// A position that tells which exchange it came from, well within all limits.
double stampOf(std::int64_t n, int /*slice*/) {
  return 1e-6 * static_cast<double>(n % 20001 - 10000);
}

/// Counts exchanges whose force is not exactly the answer to the position before.
class OneTickProof {
 public:
  explicit OneTickProof(Bench& bench) {
    bench.driver->watch = [this](std::int64_t n, const double* forces) {
      if (n <= kRampTicks) {
        return;
      }
      ++checked;
      wrong += forces[0] == -kStiffness * stampOf(n - 1, 0) ? 0 : 1;
    };
  }
  std::int64_t checked = 0;
  std::int64_t wrong = 0;
};

TEST(StationTest, ForceOfATickGoesOutWithTheExchangeThatReadsTheNextPosition) {
  Bench bench({}, stampOf);
  OneTickProof proof(bench);
  bench.command(Command::Type::kEngage);
  for (int tick = 0; tick < 1'000'000; ++tick) {
    bench.station->cycle({0, true});
  }
  EXPECT_EQ(proof.checked, 1'000'000 - kRampTicks - 1);
  EXPECT_EQ(proof.wrong, 0);
}

TEST(StationTest, TellsWhatTheModelAskedForBesideWhatWasSent) {
  SpringInstrument::Setting setting;
  setting.stiffness = 5000.0;  // 50 N at 0.01 m
  Bench bench(setting);
  bench.run(kRampTicks);
  const Snapshot* snapshot = bench.station->snapshot();
  ASSERT_NE(snapshot, nullptr);
  EXPECT_EQ(snapshot->counters.peak_raw_force_n, 50.0);
  EXPECT_EQ(snapshot->counters.peak_force_n, 0.0) << "nobody engaged";
}

TEST(StationTest, ScalesPositionsAndForcesByThePort) {
  SpringInstrument::Setting setting;
  setting.port.slice = 1;
  setting.port.offset = 0.002;
  setting.port.position_scale = 4.0;
  setting.port.force_scale = 3.0;
  Bench bench(setting, [](std::int64_t, int slice) { return slice == 1 ? 0.010 : 0.05; });
  bench.engage();
  EXPECT_DOUBLE_EQ(bench.log.forces[1], 3.0 * -kStiffness * (0.010 - 0.002) / 4.0);
  EXPECT_EQ(bench.log.forces[0], 0.0);
}

TEST(StationTest, RecordsEveryTickWithItsPositionAndTheForceSentAfterIt) {
  Bench bench({}, stampOf);
  bench.command(Command::Type::kEngage);
  bench.run(1000);
  const std::vector<GestureTick> ticks = bench.recorded();
  ASSERT_EQ(ticks.size(), 1000U);
  for (std::int64_t n = 0; n < 1000; ++n) {
    const GestureTick& tick = ticks[static_cast<std::size_t>(n)];
    ASSERT_EQ(tick.tick, n);
    ASSERT_EQ(tick.flags, 0U);
    ASSERT_EQ(tick.slices, 2U);
    ASSERT_EQ(tick.position[0], stampOf(n, 0));
    if (n > kRampTicks) {
      ASSERT_EQ(tick.force[0], static_cast<float>(-kStiffness * stampOf(n, 0)));
    }
  }
}

TEST(StationTest, PushesTheModelsSamplesUnchangedFromTheFirstFrameOn) {
  SpringInstrument::Setting setting;
  setting.count_frames = true;
  setting.outputs = 5;  // more than the station's two
  Bench bench(setting);
  test::FrameLog frames(2);
  bench.station->setFramePort(&frames);
  bench.run(500);
  ASSERT_EQ(frames.samples.size(), 7000U);
  for (std::size_t f = 0; f < frames.samples.size(); ++f) {
    ASSERT_EQ(frames.indices[f], static_cast<std::int64_t>(f));
    ASSERT_EQ(frames.samples[f], static_cast<float>(f));
  }
}

TEST(StationTest, GivesLiveInputToTheModelAndMarksTheTicksThatHeardIt) {
  SpringInstrument::Setting setting;
  setting.inputs = 2;  // the second has no channel of the station: silence
  Bench bench(setting);
  test::FrameLog frames(2);
  bench.station->setFramePort(&frames);
  bench.run(1);
  EXPECT_EQ(bench.instrument->last_input, 0.0);
  frames.input_level = 0.25F;
  bench.run(1);
  EXPECT_EQ(bench.instrument->last_input, 14 * 0.25);
  const std::vector<GestureTick> ticks = bench.recorded();
  ASSERT_EQ(ticks.size(), 2U);
  EXPECT_EQ(ticks[0].flags, GestureTick::kNoForce);
  EXPECT_EQ(ticks[1].flags, GestureTick::kAudioInput | GestureTick::kNoForce);
}

TEST(StationTest, HoldsForcesAtZeroUntilEngagedThenRampsThenPlays) {
  Bench bench;
  bench.run(500);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  bench.command(Command::Type::kEngage);
  bench.run(2);
  EXPECT_LE(std::abs(bench.log.forces[0]), 0.01);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], -1.0);
  const auto events = bench.events();
  EXPECT_EQ(test::firstOf(events, Event::Type::kEngaged).tick, 500);
  const std::int64_t ramp = test::firstOf(events, Event::Type::kPlaying).tick - 500;
  EXPECT_NEAR(static_cast<double>(ramp), 315.0, 2.0);  // 0.1 s at 3150 Hz
}

TEST(StationTest, StopsForceWithTheNextExchange) {
  Bench bench;
  bench.engage();
  bench.run(1);
  EXPECT_EQ(bench.log.forces[0], -1.0);
  bench.station->stop();
  bench.run(1);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kStopped), 1);
}

TEST(StationTest, ShowsStatePositionsAndForcesAtTheDisplayRate) {
  Bench bench({}, stampOf);
  bench.command(Command::Type::kEngage);
  int shown = 0;
  const Snapshot* last = nullptr;
  for (int i = 0; i < 3150; ++i) {
    bench.run(1);
    if (const Snapshot* s = bench.station->snapshot()) {
      ++shown;
      last = s;
      ASSERT_EQ(s->slice_position[0], stampOf(s->tick, 0));
    }
  }
  EXPECT_NEAR(shown, 60, 2);
  ASSERT_NE(last, nullptr);
  EXPECT_EQ(last->state, ForceState::kPlaying);
  EXPECT_EQ(last->slices, 2);
  EXPECT_EQ(last->slice_force[0], -kStiffness * last->slice_position[0]);
  EXPECT_NEAR(last->slice_velocity[0], 1e-6 * 3150.0, 1e-9);
  EXPECT_EQ(last->counters.ticks, last->tick);
  EXPECT_FALSE(last->audio_running);
}

TEST(StationTest, MakeSafeZeroesForceAndLatchesUntilRecovered) {
  Bench bench;
  bench.engage();
  bench.station->makeSafe();
  EXPECT_TRUE(bench.log.safe.load());
  bench.run(2);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  const auto events = bench.events();
  EXPECT_EQ(test::firstOf(events, Event::Type::kFault).index,
            static_cast<int>(FaultReason::kMadeSafe));
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], 0.0) << "recover comes first";
  const auto refused = bench.events();
  EXPECT_EQ(test::firstOf(refused, Event::Type::kRefused).index, static_cast<int>(Refusal::kFault));
  bench.command(Command::Type::kRecover);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0) << "force never comes back by itself";
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0);
}

TEST(StationTest, TellsTheReasonGivenWithMakeSafe) {
  Bench bench;
  bench.station->makeSafe(FaultReason::kEmergencyStop);
  bench.station->makeSafe(FaultReason::kWatchdog);
  bench.run(1);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kFault).index,
            static_cast<int>(FaultReason::kEmergencyStop));
}

/// As long as no tick runs a device may have the last force still.
TEST(StationTest, RecoverSetsTheDriverFreeInItsTick) {
  Bench bench;
  bench.engage();
  bench.station->makeSafe();
  bench.command(Command::Type::kRecover);
  EXPECT_TRUE(bench.log.safe.load());
  bench.run(1);
  EXPECT_FALSE(bench.log.safe.load());
}

TEST(StationTest, RecoveringRampsFromZeroAndEngagingAgainIsNoKick) {
  Bench bench;
  bench.engage();
  bench.command(Command::Type::kRecover);
  bench.command(Command::Type::kEngage);
  bench.run(2);
  EXPECT_LE(std::abs(bench.log.forces[0]), 0.01);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], -1.0);
  for (int i = 0; i < 10; ++i) {
    bench.command(Command::Type::kEngage);
    bench.run(1);
    EXPECT_EQ(bench.log.forces[0], -1.0);
  }
}

TEST(StationTest, FaultsOnAPositionThatIsNotANumberAndPlaysTheLastGoodOne) {
  Bench bench({}, [](std::int64_t n, int) { return n == 600 ? std::nan("") : 0.01; });
  bench.command(Command::Type::kEngage);
  bench.run(602);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  const Event fault = test::firstOf(bench.events(), Event::Type::kFault);
  EXPECT_EQ(fault.tick, 600);
  EXPECT_EQ(fault.index, static_cast<int>(FaultReason::kBadPosition));
  EXPECT_EQ(fault.value, 0.0);
  const std::vector<GestureTick> ticks = bench.recorded();
  ASSERT_EQ(ticks.size(), 602U);
  EXPECT_EQ(ticks[600].position[0], 0.01);
  EXPECT_EQ(ticks[599].flags, 0U) << "force was on";
  EXPECT_EQ(ticks[600].flags, GestureTick::kHeld | GestureTick::kNoForce);
  EXPECT_EQ(ticks[601].flags, GestureTick::kNoForce);
}

TEST(StationTest, FaultsOnceWhenTheDeviceIsLost) {
  Bench bench;
  bench.driver->flags_of = [](std::int64_t n) { return n >= 600 ? tgr::kDeviceLost : 0U; };
  bench.command(Command::Type::kEngage);
  bench.run(900);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  const auto events = bench.events();
  EXPECT_EQ(test::count(events, Event::Type::kFault), 1);
  EXPECT_EQ(test::firstOf(events, Event::Type::kFault).index,
            static_cast<int>(FaultReason::kDeviceLost));
}

/// A model that goes wrong at tick 600 must reach neither hand nor ear, in whatever way it does.
class BlowUpTest : public ::testing::TestWithParam<std::int64_t SpringInstrument::Setting::*> {};

TEST_P(BlowUpTest, MutesForceAndAudioUntilASwap) {
  SpringInstrument::Setting setting;
  setting.*GetParam() = 600;
  Bench bench(setting);
  test::FrameLog frames(2);
  bench.station->setFramePort(&frames);
  bench.command(Command::Type::kEngage);
  bench.run(700);
  EXPECT_EQ(bench.log.forces[0], 0.0);
  EXPECT_TRUE(std::all_of(frames.samples.begin(), frames.samples.end(),
                          [](float s) { return s == 0.5F || s == 0.0F; }));
  EXPECT_EQ(frames.samples.back(), 0.0F);
  const Event fault = test::firstOf(bench.events(), Event::Type::kFault);
  EXPECT_EQ(fault.index, static_cast<int>(FaultReason::kModelBlowUp));
  EXPECT_GE(fault.tick, 600);
  EXPECT_LE(fault.tick, 600 + 53);  // a displacement is looked at 60 times a second

  bench.command(Command::Type::kEngage);  // refused: nothing sane to feel
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0);

  ASSERT_TRUE(bench.swap(test::makeSpring()));
  bench.run(100);
  bench.command(Command::Type::kRecover);
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0);
  EXPECT_EQ(frames.samples.back(), 0.5F);
  const auto events = bench.events();
  EXPECT_EQ(test::firstOf(events, Event::Type::kRecovered).index, 0);
}

TEST_P(BlowUpTest, BeginsAnewOnRecovery) {
  SpringInstrument::Setting setting;
  setting.*GetParam() = 600;
  setting.count_frames = true;
  Bench bench(setting);
  test::FrameLog frames(2);
  bench.station->setFramePort(&frames);
  bench.run(700);
  bench.command(Command::Type::kRecover);
  bench.run(1);
  EXPECT_EQ(frames.samples.back(), 13.0F) << "the first tick of the model";
  bench.engage();
  EXPECT_EQ(bench.log.forces[0], -1.0);
  EXPECT_EQ(test::firstOf(bench.events(), Event::Type::kRecovered).index, 1);
}

INSTANTIATE_TEST_SUITE_P(ForceSampleDisplacement,
                         BlowUpTest,
                         ::testing::Values(&SpringInstrument::Setting::bad_force_at,
                                           &SpringInstrument::Setting::bad_sample_at,
                                           &SpringInstrument::Setting::bad_displacement_at));

TEST(StationTest, CountsALateWakeUpByItsCause) {
  Bench bench;
  bench.station->cycle({1'000'000, false});  // a tick is 317 us
  const auto events = bench.events();
  EXPECT_EQ(test::lateEvents(events, LateCause::kWakeUp), 1);
  EXPECT_EQ(test::firstOf(events, Event::Type::kLateTick).tick, 0);
  EXPECT_DOUBLE_EQ(test::firstOf(events, Event::Type::kLateTick).value, 1e-3);
}

TEST(StationTest, CountsAsLateWhatComesMoreThanATickAfterItsTime) {
  Bench bench;
  bench.station->cycle({317'460, false});
  bench.station->cycle({317'461, false});
  EXPECT_EQ(test::lateEvents(bench.events(), LateCause::kWakeUp), 1);
}

TEST(StationTest, SendsZeroForceWhenItRests) {
  Bench bench;
  bench.engage();
  bench.station->rest();
  EXPECT_EQ(bench.log.forces[0], 0.0);
  bench.run(kRampTicks);
  EXPECT_EQ(bench.log.forces[0], 0.0) << "engage is needed again";
}

TEST(StationTest, ClosesTheDriverAtTheEnd) {
  Bench bench;
  EXPECT_TRUE(bench.log.open);
  bench.station.reset();
  EXPECT_FALSE(bench.log.open);
}

TEST(StationTest, RefusesAModelOfAnotherRateOrASliceThatIsNotThere) {
  SpringInstrument::Setting other_rate;
  other_rate.ratio = 7;
  EXPECT_THROW(Bench{other_rate}, Exception);
  SpringInstrument::Setting other_slice;
  other_slice.port.slice = 2;
  EXPECT_THROW(Bench{other_slice}, Exception);
}

TEST(StationTest, RefusesSettingsOutsideTheirRange) {
  const auto position = [](std::int64_t, int) { return 0.0; };
  StationConfig no_channels = Bench::quickConfig();
  no_channels.output_channels = 0;
  EXPECT_THROW((Bench{{}, position, no_channels}), Exception);
  StationConfig endless_stall = Bench::quickConfig();
  endless_stall.max_stall_s = 10.0;
  EXPECT_THROW((Bench{{}, position, endless_stall}), Exception);
  StationConfig no_display = Bench::quickConfig();
  no_display.display_hz = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((Bench{{}, position, no_display}), Exception);
}

}  // namespace
}  // namespace ergotic::station
