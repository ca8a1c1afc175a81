// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/station.hpp"
#include "support/station_doubles.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

using test::Bench;
using test::kRampTicks;
using test::SpringInstrument;

constexpr int kFadeTicks = 16;  // 5 ms at 3150 Hz, rounded up

Command stiffness(const Performer& performer, double value) {
  Command command;
  command.type = Command::Type::kParameter;
  command.value = value;
  command.coefficients = performer.instrument->prepare({value}).release();
  return command;
}

TEST(SwapFadeTest, IsAStraightLineThatEndsExactly) {
  SwapFade fade(3, 4);
  EXPECT_EQ(fade.gainAt(0), 1.0);
  fade.startOut();
  double expected = 1.0;
  for (int tick = 0; tick < 3; ++tick) {
    for (int r = 0; r < 4; ++r) {
      expected -= 1.0 / 12.0;
      EXPECT_NEAR(fade.gainAt(r), expected, 1e-15);
    }
    fade.advance();
  }
  EXPECT_TRUE(fade.isSilent());
  fade.startIn();
  for (int tick = 0; tick < 2; ++tick) {
    fade.advance();
  }
  EXPECT_EQ(fade.gainAt(3), 1.0);
  fade.advance();
  EXPECT_TRUE(fade.isFull());
}

TEST(CommandsTest, SwapsAtATickBoundaryAfterAFadeOfFixedLength) {
  Bench bench;
  bench.run(100);
  Performer* old = nullptr;
  ASSERT_TRUE(bench.swap(test::makeSpring()));
  bench.run(100);
  const auto events = bench.events();
  ASSERT_EQ(test::count(events, Event::Type::kSwapped), 1);
  const Event swapped = test::firstOf(events, Event::Type::kSwapped);
  EXPECT_EQ(swapped.tick, 100 + 1 + kFadeTicks);
  EXPECT_EQ(swapped.index, 1);
  old = swapped.performer;
  ASSERT_NE(old, nullptr);
}

TEST(CommandsTest, SwapUnderPlayHasNoStepInAudioAndNoGrowthInForce) {
  SpringInstrument::Setting loud;
  loud.level = 1.0;
  Bench bench(loud);
  test::FrameLog frames(2);
  bench.station->setFramePort(&frames);
  std::vector<double> forces;
  bench.driver->watch = [&](std::int64_t, const double* f) { forces.push_back(f[0]); };
  bench.command(Command::Type::kEngage);
  bench.run(500);
  SpringInstrument::Setting inverse;
  inverse.level = -1.0;
  inverse.stiffness = 500.0;
  ASSERT_TRUE(bench.swap(test::makeSpring(inverse)));
  bench.run(1000);

  float largest_step = 0.0F;
  for (std::size_t f = 1; f < frames.samples.size(); ++f) {
    largest_step = std::max(largest_step, std::abs(frames.samples[f] - frames.samples[f - 1]));
  }
  EXPECT_LE(largest_step, 1.0001F / (kFadeTicks * 14));
  EXPECT_EQ(frames.samples[500 * 14], 1.0F);
  for (std::size_t f = 0; f < kFadeTicks * 14; ++f) {
    EXPECT_NEAR(frames.samples[501 * 14 + f], 1.0 - static_cast<double>(f + 1) / (kFadeTicks * 14),
                1e-6);
    EXPECT_NEAR(frames.samples[(501 + kFadeTicks) * 14 + f],
                -static_cast<double>(f + 1) / (kFadeTicks * 14), 1e-6);
  }
  EXPECT_EQ(frames.samples.back(), -1.0F);

  // |F| = 1 N before, falls to zero with the fade, then grows by a ramp step of 5 N / 157 at most.
  EXPECT_EQ(forces[500], -1.0);
  for (int k = 1; k <= kFadeTicks; ++k) {
    EXPECT_NEAR(forces[501U + static_cast<std::size_t>(k)], -1.0 + k / 16.0, 1e-12);
  }
  for (std::size_t n = 502; n < forces.size(); ++n) {
    ASSERT_LE(std::abs(forces[n]) - std::abs(forces[n - 1]), 5.0 / 157.0) << "exchange " << n;
  }
  EXPECT_EQ(*std::max_element(forces.begin() + 501, forces.begin() + 530), 0.0);
  EXPECT_EQ(forces.back(), -5.0);
}

TEST(CommandsTest, HandsBackASupersededPerformerThatNeverPlayed) {
  int destroyed = 0;
  SpringInstrument::Setting counted;
  counted.destroyed = &destroyed;
  Bench bench;
  auto made = test::makeSpring(counted);
  const Performer* first = made.get();
  ASSERT_TRUE(bench.swap(std::move(made)));
  made = test::makeSpring(counted);
  const Performer* second = made.get();
  ASSERT_TRUE(bench.swap(std::move(made)));
  bench.run(100);
  const auto events = bench.events();
  ASSERT_EQ(test::count(events, Event::Type::kSwapped), 2);
  EXPECT_EQ(events[0].performer, first);
  EXPECT_EQ(events[0].index, 0);
  EXPECT_NE(events[1].performer, second);
  EXPECT_EQ(events[1].index, 1);
  bench.performers.clear();
  EXPECT_EQ(destroyed, 1);
  bench.station.reset();
  EXPECT_EQ(destroyed, 2);
}

TEST(CommandsTest, NeverLosesAPerformerHoweverFullTheEventRingIs) {
  int destroyed = 0;
  SpringInstrument::Setting counted;
  counted.destroyed = &destroyed;
  StationConfig config = Bench::quickConfig();
  config.event_ring = 8;
  config.command_ring = 4;
  {
    Bench bench(
        counted, [](std::int64_t, int) { return 0.0; }, config);
    for (int i = 0; i < 100; ++i) {
      bench.station->cycle({10'000'000, false});  // each is late: the ring is full of that
    }
    int submitted = 0;
    int returned = 0;
    for (int i = 0; i < 50; ++i) {
      submitted += bench.swap(test::makeSpring()) ? 1 : 0;
      bench.run(1);
    }
    EXPECT_EQ(submitted, 4) << "further swaps are refused until someone polls";
    bench.run(100);
    for (const Event& event : bench.events()) {
      returned += event.performer != nullptr ? 1 : 0;
    }
    bench.performers.clear();
    EXPECT_EQ(returned, 4);
    EXPECT_TRUE(bench.swap(test::makeSpring(counted)));
    EXPECT_EQ(destroyed, 1) << "the first, among those handed back";
  }
  EXPECT_EQ(destroyed, 2) << "and the one that still waited";
}

TEST(CommandsTest, RefusesAPerformerThatDoesNotFitAndKeepsThePlayingOne) {
  Bench bench;
  SpringInstrument::Setting wide;
  wide.port.slice = 7;
  EXPECT_THROW(bench.swap(test::makeSpring(wide)), Exception);
  bench.run(100);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kSwapped), 0);
}

TEST(CommandsTest, RefusesCommandsThatCarryNothing) {
  Bench bench;
  EXPECT_THROW(bench.command(Command::Type::kSwap), Exception);
  EXPECT_THROW(bench.command(Command::Type::kParameter), Exception);
}

TEST(CommandsTest, TakesAParameterAtTheNextTickAndGivesTheOldCoefficientsBack) {
  auto prepared = test::makeSpring();
  Bench bench;
  bench.command(Command::Type::kEngage);
  bench.run(500);
  ASSERT_TRUE(bench.station->submit(stiffness(*prepared, 300.0)));
  bench.run(2);
  EXPECT_DOUBLE_EQ(bench.log.forces[0], -3.0);
  const Event taken = test::firstOf(bench.events(), Event::Type::kParameter);
  EXPECT_EQ(taken.tick, 500);
  EXPECT_EQ(taken.value, 300.0);
  ASSERT_NE(taken.coefficients, nullptr);
}

TEST(CommandsTest, GivesAParameterToThePerformerSubmittedLast) {
  Bench bench;
  bench.command(Command::Type::kEngage);
  bench.run(500);
  auto made = test::makeSpring();
  Performer* next = made.get();
  ASSERT_TRUE(bench.swap(std::move(made)));
  ASSERT_TRUE(bench.station->submit(stiffness(*next, 300.0)));
  bench.run(2);
  EXPECT_GE(bench.log.forces[0], -1.0) << "the one still fading out keeps its own";
  bench.run(1000);
  EXPECT_DOUBLE_EQ(bench.log.forces[0], -3.0);
  EXPECT_EQ(next->parameters[0], 300.0);
}

TEST(CommandsTest, KeyframeHoldsStateAndParametersBeforeTheTickItNames) {
  auto prepared = test::makeSpring();
  Bench bench;
  bench.run(10);
  ASSERT_TRUE(bench.station->submit(stiffness(*prepared, 250.0)));
  ASSERT_TRUE(bench.command(Command::Type::kKeyframe));
  bench.run(1);
  const auto events = bench.events();
  ASSERT_EQ(test::firstOf(events, Event::Type::kKeyframe).index, 1);
  const Keyframe& keyframe = bench.station->keyframe();
  EXPECT_EQ(keyframe.tick, 10);
  SpringInstrument restored({});
  ASSERT_EQ(keyframe.state.size(), restored.stateSize());
  restored.loadState(keyframe.state.data());
  float frames = 0.0F;
  restored.readDisplacements(&frames);
  EXPECT_EQ(frames, 140.0F);
  EXPECT_EQ(keyframe.parameters, std::vector<double>{250.0});
}

TEST(CommandsTest, TakesNoKeyframeWithinTheFadeOfASwap) {
  Bench bench;
  ASSERT_TRUE(bench.swap(test::makeSpring()));
  bench.run(5);
  ASSERT_TRUE(bench.command(Command::Type::kKeyframe));
  bench.run(100);
  const auto events = bench.events();
  ASSERT_EQ(test::count(events, Event::Type::kKeyframe), 1);
  EXPECT_EQ(test::firstOf(events, Event::Type::kKeyframe).tick, 1 + 2 * kFadeTicks);
}

TEST(CommandsTest, SaysWhenAStateIsTooLargeForAKeyframe) {
  StationConfig config = Bench::quickConfig();
  config.keyframe_bytes = 4;
  Bench bench(
      {}, [](std::int64_t, int) { return 0.0; }, config);
  bench.command(Command::Type::kKeyframe);
  bench.run(1);
  const auto events = bench.events();
  ASSERT_EQ(test::count(events, Event::Type::kKeyframe), 1);
  EXPECT_EQ(events[0].index, 0);
}

// With several threads, one of them may still be at its share of the last tick.
TEST(HeldUpTest, AParameterIsToldAsSetWhenItIs) {
  Bench bench;
  bench.engage();
  const double before = bench.log.forces[0];
  bench.instrument->held_up = true;
  bench.run(1);
  Command change;
  change.type = Command::Type::kParameter;
  change.value = 2.0 * SpringInstrument::Setting().stiffness;
  change.coefficients = bench.instrument->prepare({change.value}).release();
  ASSERT_TRUE(bench.station->submit(change));
  bench.run(10);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kParameter), 0);
  bench.instrument->held_up = false;
  bench.run(1);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kParameter), 1);
  bench.run(kRampTicks);
  EXPECT_DOUBLE_EQ(bench.log.forces[0], 2.0 * before);
}

// The second keyframe would be written while the first is read.
TEST(KeyframeTest, IsNotWrittenAgainBeforeItWasHeardOf) {
  Bench bench;
  for (int n = 0; n < 3; ++n) {
    ASSERT_TRUE(bench.command(Command::Type::kKeyframe));
    bench.run(5);
  }
  EXPECT_EQ(test::count(bench.events(), Event::Type::kKeyframe), 1);
  EXPECT_EQ(bench.station->keyframe().tick, 0);
  ASSERT_TRUE(bench.command(Command::Type::kKeyframe));
  bench.run(1);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kKeyframe), 1);
  EXPECT_EQ(bench.station->keyframe().tick, 15);
}

TEST(KeyframeTest, OfALargeStateWaitsUntilThereIsNoForce) {
  StationConfig config = Bench::quickConfig();
  config.keyframe_bytes_in_force = 1;
  Bench bench(
      {}, [](std::int64_t, int) { return 0.01; }, config);
  bench.engage();
  ASSERT_TRUE(bench.command(Command::Type::kKeyframe));
  bench.run(100);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kKeyframe), 0);
  bench.station->stop();
  bench.run(2);
  EXPECT_EQ(test::count(bench.events(), Event::Type::kKeyframe), 1);
}

}  // namespace
}  // namespace ergotic::station
