// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay.hpp"

#include <cstring>

#include "replay/live_run.hpp"
#include "support/struck_bar.hpp"
#include "support/test.hpp"

namespace ergotic::replay {
namespace {

using test::LiveRun;

const std::string kStruckScene = test::struckBar("{quantity: velocity, at: bar, channel: 1}");

std::string otherScene() {
  std::string text = kStruckScene;
  text.replace(text.find("mass: 0.001"), 11, "mass: 0.003");
  return text;
}

struct Replayed {
  std::int64_t first_tick = 0;
  std::vector<float> sound;
  std::vector<std::string> flaws;
  physics::CompileOptions options;
};

Replayed replay(const bag::Recording& recording,
                const CompileChoice& choice = {},
                const station::PerformerPolicy& policy = {}) {
  Replay player(recording, policy, choice);
  Replayed result;
  result.options = player.instrument().options();
  result.first_tick = player.start().tick;
  std::vector<double> frames(static_cast<std::size_t>(player.rates().ratio));
  while (player.next(frames.data())) {
    result.sound.insert(result.sound.end(), frames.begin(), frames.end());
  }
  result.flaws = player.flaws();
  return result;
}

/// Fails unless the replay is the performance, bit for bit, from the replay's first tick to the
/// performance's end.
void expectSame(const Replayed& got, const std::vector<float>& live) {
  EXPECT_THAT(got.flaws, IsEmpty());
  const auto first = static_cast<std::size_t>(got.first_tick * LiveRun::kRates.ratio);
  ASSERT_EQ(got.sound.size(), live.size() - first);
  std::size_t different = 0;
  float peak = 0.0F;
  for (std::size_t i = 0; i < got.sound.size(); ++i) {
    different += got.sound[i] != live[first + i] ? 1 : 0;
    peak = std::max(peak, std::abs(live[first + i]));
  }
  EXPECT_EQ(different, 0U);
  EXPECT_GT(peak, 1e-3F);
}

TEST(ReplayTest, IsThePerformanceBitForBitFromAKeyframeInItsMiddle) {
  LiveRun live(kStruckScene);
  live.play(700);
  live.takeKeyframe();
  live.play(3000);
  const Replayed again = replay(live.recording());
  EXPECT_EQ(again.first_tick, 700);
  expectSame(again, live.sound());
}

TEST(ReplayTest, KnowsTheSlicesFromTheGestureWhereAnOldKeyframeDoesNot) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(1000);
  bag::Recording recording = live.recording();
  ASSERT_GT(recording.keyframes.front().slices, 0);
  recording.keyframes.front().slices = 0;
  expectSame(replay(recording), live.sound());
}

TEST(ReplayTest, TakesParametersAtTheirTicks) {
  LiveRun live(kStruckScene);
  live.setParameter(0, 3000.0);
  live.play(500);
  live.takeKeyframe();
  live.play(1003);
  live.setParameter(0, 7000.0);
  live.play(1500);
  expectSame(replay(live.recording()), live.sound());
}

TEST(ReplayTest, HoldsWhatHandsHeldFromTheMiddleOfTheirWayOn) {
  LiveRun live(kStruckScene);
  live.play(100);
  constexpr int kBar = 1;
  live.hold(1, kBar, 0.01);
  live.play(103);
  live.takeKeyframe();  // on its way
  live.play(50);
  live.hold(1, kBar, -0.005);
  live.hold(2, kBar, 0.003);
  live.play(300);
  live.takeKeyframe();
  live.play(300);
  live.letGo(1);
  live.takeKeyframe();  // at the tick in which it lets go
  live.play(301);
  live.hold(3, kBar, 0.002);
  live.swap(otherScene());
  live.play(1000);
  live.hold(0, kBar, 0.004);
  live.play(10);
  live.takeKeyframe();
  live.play(500);
  const auto holds = [&live](const station::Event& event) {
    return event.type == station::Event::Type::kHold && event.hold.mat == kBar &&
           live.recording().keyframes.front().tick <= event.tick;
  };
  const auto& events = live.recording().events;
  EXPECT_GE(std::count_if(events.begin(), events.end(), holds), 8);
  expectSame(replay(live.recording()), live.sound());
  for (std::size_t first = 1; first < live.recording().keyframes.size(); ++first) {
    bag::Recording later = live.recording();
    later.keyframes.erase(later.keyframes.begin(),
                          later.keyframes.begin() + static_cast<std::ptrdiff_t>(first));
    expectSame(replay(later), live.sound());
  }
}

TEST(ReplayTest, FollowsOtherEndEffectorsAndTheirGlide) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(1003);
  live.configure(1.5);
  live.play(100);
  live.configure(-0.5);  // within the glide of the first
  live.play(2000);
  live.takeKeyframe();
  live.play(10);
  expectSame(replay(live.recording()), live.sound());
}

TEST(ReplayTest, SaysWhenTheModelHasOtherPorts) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(100);
  bag::Recording recording = live.recording();
  for (bag::Stretch& stretch : recording.stretches) {
    stretch.ports = 0;
    stretch.ports_at.clear();
  }
  EXPECT_THAT(replay(recording).flaws, ElementsAre(HasSubstr("0 ports were recorded")));
}

TEST(ReplayTest, FollowsStallsAndLeavesLostTicksSilent) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(1210);
  live.stall(20);
  live.play(1005);
  live.stall(400);  // 157 ticks are run, 243 are lost
  live.play(1000);
  live.takeKeyframe();
  live.play(50);
  expectSame(replay(live.recording()), live.sound());
}

TEST(ReplayTest, SwapsModelsWithTheSameFade) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(1300);
  live.swap(otherScene());
  live.play(5);
  live.setParameter(0, 5000.0);  // of the model that is still to come
  live.play(20);
  live.takeKeyframe();
  live.play(2000);
  expectSame(replay(live.recording()), live.sound());
}

// The second swap waits for the end of the fade of the first, longer than a swap takes by itself.
TEST(ReplayTest, GivesAParameterToTheModelThatWaitedForAnEarlierSwap) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(1300);
  live.swap(otherScene());
  live.play(18);
  live.takeKeyframe();  // it has begun to play
  live.play(2);
  live.swap(kStruckScene);
  live.play(2);
  live.setParameter(0, 5000.0);
  live.play(1);
  live.setParameter(0, 7000.0);
  live.play(100);
  live.takeKeyframe();
  live.play(2000);
  expectSame(replay(live.recording()), live.sound());
}

TEST(ReplayTest, GivesNoModelAParameterOfOneThatNeverPlayed) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(1300);
  live.swap(kStruckScene);
  live.play(5);
  live.setParameter(0, 7000.0);
  live.play(2);
  live.swap(otherScene());  // instead
  live.play(100);
  live.takeKeyframe();
  live.play(2000);
  expectSame(replay(live.recording()), live.sound());
}

TEST(ReplayTest, BlowsUpAndBeginsAnewAsThePerformanceDid) {
  std::string unstable = kStruckScene;
  unstable.replace(unstable.find("[1000, 8000]"), 12, "[1000, 9e6]");
  unstable.replace(unstable.find("type: cell,"), 11, "type: cell, matched: false,");
  station::PerformerPolicy policy;
  policy.allow_unstable = true;
  LiveRun live(unstable, {}, policy);
  live.takeKeyframe();
  live.play(900);
  live.setParameter(0, 9e6);
  live.play(300);
  live.setParameter(0, 3000.0);
  live.play(5);
  live.recover();
  live.play(2000);
  live.takeKeyframe();
  live.play(10);
  const std::vector<float>& sound = live.sound();
  EXPECT_EQ(sound[1199 * LiveRun::kRates.ratio], 0.0F) << "it did not blow up";
  const Replayed again = replay(live.recording(), {}, policy);
  expectSame(again, sound);
  bag::Recording untold = live.recording();
  auto& events = untold.events;
  events.erase(std::remove_if(events.begin(), events.end(),
                              [](const station::Event& event) {
                                return event.type == station::Event::Type::kFault ||
                                       event.type == station::Event::Type::kRecovered;
                              }),
               events.end());
  EXPECT_THAT(replay(untold, {}, policy).flaws,
              ElementsAre(HasSubstr("the model blows up, which it did not then at tick 9"),
                          HasSubstr("not in the recorded state")));
  bag::Recording stable = live.recording();
  for (station::Event& event : stable.events) {
    event.value = event.type == station::Event::Type::kParameter ? 3000.0 : event.value;
  }
  EXPECT_THAT(replay(stable, {}, policy).flaws,
              ElementsAre(HasSubstr("had blown up, which it does not now at tick"),
                          HasSubstr("not in the recorded state")));
}

TEST(ReplayTest, FindsWhatBlowsUpUnheardAtTheTickOfThePerformance) {
  std::string unstable = kStruckScene;
  unstable.insert(unstable.find("sections:"), "  inside: {value: 1000, range: [1000, 9e6]}\n");
  unstable.insert(unstable.find("lias:"),
                  "  unheard: {type: cell, section: sound, matched: false, mass: 0.001, "
                  "stiffness: $inside, x: 0.01}\n");
  station::PerformerPolicy policy;
  policy.allow_unstable = true;
  LiveRun live(unstable, {}, policy);
  live.play(733);
  live.takeKeyframe();
  live.play(100);
  live.stall(407);  // some of them are lost
  live.play(200);
  live.setParameter(1, 9e6);
  live.play(500);
  const Replayed again = replay(live.recording(), {}, policy);
  EXPECT_THAT(again.flaws, ElementsAre());
  EXPECT_EQ(live.sound().back(), 0.0F);
  expectSame(again, live.sound());
}

/// A performance with a keyframe in its middle and one near its end.
bag::Recording recordingOf(LiveRun& live) {
  live.play(700);
  live.takeKeyframe();
  live.play(1800);
  live.takeKeyframe();
  live.play(50);
  return live.recording();
}

TEST(ReplayTest, TakesPrecisionKernelsThreadsAndEnergiesFromTheRecording) {
  physics::CompileOptions options(physics::Precision::kDouble);
  options.isa = rt::Isa::kBaseline;
  options.threads = 2;
  options.metered = false;
  LiveRun live(kStruckScene, options);
  const Replayed again = replay(recordingOf(live));
  EXPECT_EQ(again.options.precision, physics::Precision::kDouble);
  EXPECT_EQ(again.options.isa, rt::Isa::kBaseline);
  EXPECT_EQ(again.options.threads, 2);
  EXPECT_FALSE(again.options.metered);
  expectSame(again, live.sound());
}

CompileChoice with(rt::Isa isa, int threads) {
  return [=](physics::CompileOptions options) {
    options.isa = isa;
    options.threads = threads;
    return options;
  };
}

TEST(ReplayTest, PlaysTheSameStatesAndSamplesWithAnyKernelsAndThreads) {
  LiveRun live(kStruckScene);
  const bag::Recording recording = recordingOf(live);
  for (const rt::Isa isa : rt::isas()) {
    for (const int threads : {1, 2}) {
      const Replayed again = replay(recording, with(isa, threads));
      EXPECT_EQ(again.options.isa, isa);
      EXPECT_EQ(again.options.threads, threads);
      expectSame(again, live.sound());
    }
  }
}

TEST(ReplayTest, TakesTheBestKernelsWhereThisProcessorLacksTheRecordedOnes) {
  LiveRun live(kStruckScene);
  bag::Recording recording = recordingOf(live);
  for (bag::Keyframe& keyframe : recording.keyframes) {
    keyframe.isa = "avx4096";
  }
  const Replayed again = replay(recording);
  EXPECT_EQ(again.options.isa, rt::bestIsa());
  expectSame(again, live.sound());
}

TEST(ReplayTest, SaysWhereTicksAreMissing) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(1280);
  bag::Recording recording = live.recording();
  ASSERT_EQ(recording.stretches.at(5).first_tick, 320);
  recording.stretches.erase(recording.stretches.begin() + 5);
  EXPECT_THAT(
      replay(recording).flaws,
      ElementsAre("the replay may differ from what was played: gap of 64 ticks at tick 320"));
}

TEST(ReplayTest, ChecksItselfAgainstLaterKeyframes) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(900);
  live.takeKeyframe();
  live.play(10);
  bag::Recording recording = live.recording();
  recording.keyframes.at(1).state.at(0) ^= 1U;
  EXPECT_THAT(replay(recording).flaws,
              ElementsAre("the replay may differ from what was played: the model is not in the "
                          "recorded state at tick 900"));
}

TEST(ReplayTest, SaysWhenLiveSoundWasHeard) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(100);
  bag::Recording recording = live.recording();
  recording.stretches.at(0).flags.at(40) |= station::GestureTick::kAudioInput;
  recording.stretches.at(0).flags.at(41) |= station::GestureTick::kAudioInput;
  EXPECT_THAT(replay(recording).flaws, ElementsAre(HasSubstr("live sound")));
}

TEST(ReplayTest, RefusesTheStateOfAnotherBuild) {
  LiveRun live(kStruckScene);
  live.takeKeyframe();
  live.play(100);
  bag::Recording recording = live.recording();
  recording.keyframes.at(0).state.pop_back();
  recording.keyframes.at(0).build = "0.0.1 abc";
  EXPECT_THAT(complaintOf([&] { replay(recording); }),
              AllOf(HasSubstr("another build"), HasSubstr("0.0.1 abc")));
}

bag::Recording shortRecording() {
  LiveRun live(kStruckScene);
  live.play(20);
  live.takeKeyframe();
  live.play(20);
  return live.recording();
}

TEST(ReplayTest, RefusesAStateThatIsNoNumberUnlessTheModelHadBlownUp) {
  bag::Recording recording = shortRecording();
  ASSERT_FALSE(recording.keyframes.empty());
  std::vector<std::uint8_t>& state = recording.keyframes[0].state;
  const float none = std::nanf("");
  std::memcpy(&state[64], &none, sizeof none);  // after the frame: the first of x
  EXPECT_THAT(complaintOf([&] { replay(recording); }),
              HasSubstr("the recorded state of tick 20: number 0 of 'x' is nan, allowed: finite"));
  station::Event recovered;
  recovered.type = station::Event::Type::kRecovered;
  recovered.tick = 30;
  recovered.index = 1;
  recording.events.push_back(recovered);
  EXPECT_EQ(complaintOf([&] { replay(recording); }), "");
}

TEST(ReplayTest, RefusesAChangeOfAParameterThatTheModelDoesNotHave) {
  for (const std::int64_t index : {-1, 1}) {
    bag::Recording recording = shortRecording();
    station::Event change;
    change.type = station::Event::Type::kParameter;
    change.tick = 30;
    change.index = index;
    recording.events.push_back(change);
    EXPECT_THAT(
        complaintOf([&] { replay(recording); }),
        HasSubstr("at tick 30 is of number " + std::to_string(index) + ", the model has 1"));
  }
}

}  // namespace
}  // namespace ergotic::replay
