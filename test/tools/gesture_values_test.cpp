// SPDX-License-Identifier: BSD-3-Clause
// A gesture file sets parameters while it is played offline.
#include <cmath>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/places.hpp"
#include "support/scene_builder.hpp"
#include "support/scratch_file.hpp"
#include "support/tool_process.hpp"
#include "tools/lib/measures.hpp"
#include "tools/lib/player.hpp"

namespace ergotic::tools {
namespace {

constexpr int kMasses = 20;
constexpr double kMassKg = 1e-3;
// A string that a key strikes from below. Its neighbours' springs follow a parameter.
const char kStruckString[] = R"(ergotic: 1
parameters:
  tension: {value: 20000, range: [10000, 100000]}
  volume: {value: 1, range: [0, 2]}
sections: {s: {rate: audio}, k: {rate: gestural}}
mats:
  key: {type: slice, section: k, at: [0.2, 0], rest: -0.002}
  place: {type: ground, section: k, x: 0.5}
generators:
  - {type: string, name: string, section: s, masses: 20, mass: 1e-3, stiffness: $tension, to: [0.65, 0]}
lias: {strike: {type: contact, between: [key, string.6], stiffness: 300}}
ports: {key: {mat: key, slice: 0}}
outputs:
  out: {at: string.4, quantity: position, channel: 1}
  place: {at: place, quantity: position, channel: 2, gain: $volume}
)";
const char kStroke[] = "0.1,0,0\n0.12,0,0.006\n0.15,0,-0.01\n";

std::unique_ptr<Player> stringPlayedBy(const std::string& csv) {
  station::PerformerPolicy policy;
  policy.allow_unproven = true;
  auto performer = station::makePerformer(scene::readYaml(kStruckString, "nowhere/string.yaml"),
                                          test::kRates, physics::Precision::kDouble, policy);
  SoundInputs inputs({}, performer->instrument->scene(), test::kRates.audio_hz);
  return makeHandPlayer(std::move(performer), std::move(inputs), csv);
}

/// [outputs]
std::array<Sound, 2> soundsOf(const std::string& rows, double seconds) {
  const test::ScratchFile csv(rows);
  const auto player = stringPlayedBy(csv.path());
  std::array<Sound, 2> sounds;
  std::vector<double> tick(2 * static_cast<std::size_t>(test::kRates.ratio));
  while (sounds[0].seconds() < seconds && player->next(tick.data())) {
    for (std::size_t i = 0; i < tick.size(); ++i) {
      sounds[i % 2].samples.push_back(tick[i]);
    }
  }
  return sounds;
}

/// Of the first mode, as it is stepped: 4 sin(pi f h)^2 = 4 sin(pi/(2 (N + 1)))^2 K h^2/M.
double pitchAt(double stiffness) {
  const double h = 1.0 / test::kRates.audio_hz;
  const double s = std::sin(0.5 * kPi / (kMasses + 1));
  return std::asin(s * h * std::sqrt(stiffness / kMassKg)) / (kPi * h);
}

TEST(GestureValuesPlayedTest, AStringSoundsAtThePitchOfItsNewTensionFromItsTimeOn) {
  const auto sounds = soundsOf(std::string(kStroke) + "1,$tension,45000\n2,$tension,20000\n", 3.0);
  constexpr double kCent = 5.8e-4;
  for (const auto& [begin_s, stiffness] : {std::pair{0.3, 2e4}, {1.05, 4.5e4}, {2.05, 2e4}}) {
    const double expected = pitchAt(stiffness);
    EXPECT_NEAR(lineNear(sounds[0], begin_s, 0.65, expected, 0.1).hz, expected,
                0.2 * kCent * expected)
        << begin_s;
  }
}

TEST(GestureValuesPlayedTest, ChangeWithTheTickInWhichTheirTimeIs) {
  const auto sounds = soundsOf("0,0,0\n0,$volume,0\n0.01,$volume,0.25\n0.02001,$volume,2\n", 0.03);
  const auto frames = static_cast<std::size_t>(test::kRates.ratio);
  const std::size_t first_of_second = 31;  // 0.01 s are 31.5 ticks
  const std::size_t first_of_third = 63;   // 0.02001 s are 63.03 ticks
  for (std::size_t n = 0; n < 90; ++n) {
    const double volume = n < first_of_second ? 0.0 : n < first_of_third ? 0.25 : 2.0;
    ASSERT_NEAR(sounds[1].samples[frames * n], 0.5 * volume, 1e-6) << n;
  }
}

TEST(GestureValuesPlayedTest, RefuseWhatTheSceneDoesNotHaveOrAllow) {
  const auto refusalOf = [](const std::string& rows) {
    const test::ScratchFile csv(rows);
    const std::string text = complaintOf<TextError>([&] { stringPlayedBy(csv.path()); });
    return text.substr(std::min(text.size(), csv.path().size()));
  };
  EXPECT_EQ(refusalOf("0,0,0\n1,$tensoin,2e4\n"),
            ":2:3: error: the scene has no parameter 'tensoin'; did you mean 'tension'?");
  EXPECT_THAT(
      refusalOf("0,0,0\n1,$tension,2e5\n"),
      StartsWith(":2:12: error: tension = 200000 is out of range, allowed: 10000...100000"));
}

TEST(GestureValuesPlayedTest, RenderPlaysThem) {
  const std::string scene = test::repository("models/string.yaml");
  const test::ScratchFile good("0,0,0\n0.05,$loss,0.0005\n");
  EXPECT_EQ(test::run("render", scene + " --seconds 0.2 --gesture " + good.path()).code, 0);
  const test::ScratchFile bad("0,0,0\n0.05,$loss,1\n");
  const test::Outcome refused =
      test::run("render", scene + " --seconds 0.2 --gesture " + bad.path());
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.text, HasSubstr(bad.path() + ":2:12: error: loss = 1"));
}

}  // namespace
}  // namespace ergotic::tools
