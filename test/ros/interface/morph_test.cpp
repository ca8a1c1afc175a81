// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/morph.hpp"

#include "ergotic/scene/text/read_scene.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::node {
namespace {

constexpr std::int64_t kBeginNs = 7'000'000'000;
constexpr std::int64_t kPollNs = 5'000'000;  // of the command thread

std::vector<scene::Parameter> twoParameters() {
  scene::Parameter even;
  even.name = "even";
  even.minimum = -1.0;
  even.maximum = 3.0;
  scene::Parameter wide = even;
  wide.name = "wide";
  wide.minimum = 1e-4;
  wide.maximum = 1.0;
  return {even, wide};
}

/// Values that a morph sets at this time, by parameters.
std::map<std::size_t, double> stepAt(Morph& morph, double seconds) {
  std::map<std::size_t, double> values;
  morph.step(kBeginNs + static_cast<std::int64_t>(seconds * 1e9),
             [&](std::size_t parameter, double value) {
               values[parameter] = value;
               return true;
             });
  return values;
}

TEST(MorphTest, GoesEvenlyAndByTheLogarithmWhereTheRangeHasMoreThanTwoDecades) {
  Morph morph(twoParameters(), {-1.0, 1e-3}, {{0, 3.0}, {1, 0.1}}, kBeginNs, 2.0);
  auto values = stepAt(morph, 0.0);
  EXPECT_DOUBLE_EQ(values[0], -1.0);
  EXPECT_DOUBLE_EQ(values[1], 1e-3);
  values = stepAt(morph, 0.5);
  EXPECT_DOUBLE_EQ(values[0], 0.0);
  EXPECT_NEAR(values[1], 1e-3 * std::sqrt(10.0), 1e-15);
  values = stepAt(morph, 1.0);
  EXPECT_DOUBLE_EQ(values[0], 1.0);
  EXPECT_NEAR(values[1], 1e-2, 1e-14);
  EXPECT_FALSE(morph.isOver());
}

TEST(MorphTest, EndsWithExactlyTheValueThatWasAskedFor) {
  const double third = 1.0 / 3.0;
  Morph morph(twoParameters(), {0.1, 0.7}, {{0, third}, {1, 1e-4 / 0.3}}, kBeginNs, 0.1);
  stepAt(morph, 0.07);
  const auto values = stepAt(morph, 0.2);
  EXPECT_EQ(values.at(0), third);
  EXPECT_EQ(values.at(1), 1e-4 / 0.3);
  EXPECT_TRUE(morph.isOver());
}

TEST(MorphTest, IsAtOnceThereInNoTime) {
  Morph morph(twoParameters(), {0.0, 0.5}, {{0, 1.0}, {1, 0.5}}, kBeginNs, 0.0);
  const auto values = stepAt(morph, 0.0);
  EXPECT_EQ(values, (std::map<std::size_t, double>{{0, 1.0}}));  // the other one is there
  EXPECT_TRUE(morph.isOver());
}

TEST(MorphTest, GoesOnWithTheNextParameterWhereThereWasNoRoom) {
  Morph morph(twoParameters(), {0.0, 0.1}, {{0, 1.0}, {1, 1.0}}, kBeginNs, 1.0);
  std::vector<std::size_t> taken;
  const auto take_one = [&taken](std::size_t parameter, double) {
    if (taken.size() % 2 == 1 && taken.back() != parameter && taken.size() < 3) {
      return false;
    }
    taken.push_back(parameter);
    return true;
  };
  morph.step(kBeginNs, take_one);
  EXPECT_THAT(taken, ElementsAre(0));
  morph.step(kBeginNs + kPollNs, [&taken](std::size_t parameter, double) {
    taken.push_back(parameter);
    return true;
  });
  EXPECT_THAT(taken, ElementsAre(0, 1, 0));
}

TEST(MorphTest, LeavesAParameterThatSomebodyElseMoves) {
  Morph morph(twoParameters(), {0.0, 0.1}, {{0, 1.0}, {1, 1.0}}, kBeginNs, 1.0);
  morph.leave(0);
  EXPECT_EQ(stepAt(morph, 2.0), (std::map<std::size_t, double>{{1, 1.0}}));
  EXPECT_TRUE(morph.isOver());
}

/// A string that swings for long, heard with a volume that a parameter sets.
const char kLoudString[] = R"(
ergotic: 1
gestural_rate: 3150
parameters: {volume: {value: 1, range: [0, 1]}}
sections: {string: {rate: audio}}
generators:
  - {type: string, name: string, section: string, masses: 60, mass: 4e-5, frequency: 220, loss: 1e-6,
     from: [0, 0], to: [0.65, 0]}
inputs: {push: {mat: string.20, quantity: force, channel: 1}}
outputs: {out: {at: string.20, quantity: velocity, channel: 1, gain: $volume}}
)";

/// Plays a pluck, with the volume at 1 or on its way from 0.5 there in two seconds.
std::vector<double> pluck(bool morphs, std::int64_t late_ns) {
  const scene::Scene scene = scene::readYaml(kLoudString, "string.yaml");
  test::Player player(scene, test::kRates);
  const double tick_ns = 1e9 / test::kRates.gesturalHz();
  constexpr double kSeconds = 2.0;
  std::vector<double> values = {morphs ? 0.5 : 1.0};
  player.instrument->exchange(player.instrument->prepare(values));
  Morph morph(scene.parameters, values, {{0, 1.0}}, 0, kSeconds);
  std::int64_t due_ns = 0;
  const int ticks = static_cast<int>((kSeconds + 0.2) * test::kRates.gesturalHz());
  for (int n = 0; n < ticks; ++n) {
    const auto now_ns = static_cast<std::int64_t>(n * tick_ns);
    std::fill(player.inputs.begin(), player.inputs.end(), n < 10 ? 0.4 : 0.0);
    if (morphs && now_ns >= due_ns) {  // as the command thread polls, which may be late
      morph.step(now_ns, [&](std::size_t index, double value) {
        values[index] = value;
        player.instrument->exchange(player.instrument->prepare(values));
        return true;
      });
      due_ns += kPollNs + late_ns;
    }
    player.tick();
  }
  return player.heard[0];
}

/// dB of full scale, of the most by which a morph is beside the same sound under a gain that is
/// as smooth as it gets, where the sound is -18 dBFS at its loudest.
double roughnessOf(std::int64_t late_ns) {
  const std::vector<double> steady = pluck(false, 0);
  const std::vector<double> morphed = pluck(true, late_ns);
  double loudest = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i < steady.size(); ++i) {
    const double time_s = static_cast<double>(i) / test::kRates.audio_hz;
    const double gain = std::min(1.0, 0.5 + 0.25 * time_s);
    loudest = std::max(loudest, std::abs(steady[i]));
    most = std::max(most, std::abs(morphed[i] - gain * steady[i]));
  }
  return 20.0 * std::log10(most / loudest) - 18.0;
}

TEST(MorphTest, StepsAreBelowMinus60DecibelsOfFullScale) {
  const double on_time = roughnessOf(0);
  EXPECT_LT(on_time, -60.0);
  EXPECT_GT(on_time, -120.0) << "nothing was morphed";
}

TEST(MorphTest, StepsStayBelowMinus60DecibelsWhereTheOperatorIsThreePollsLate) {
  EXPECT_LT(roughnessOf(15'000'000), -60.0);
}

}  // namespace
}  // namespace ergotic::node
