// SPDX-License-Identifier: BSD-3-Clause
// From a live performance through a bag and `render` to the same samples.
#include <cstdio>
#include <optional>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Keyframe.h>
#include <rosbag/bag.h>

#include "ergotic/audio/wav.hpp"
#include "replay/live_run.hpp"
#include "support/scratch_file.hpp"
#include "support/struck_bar.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::LiveRun;
using test::Outcome;
using test::run;

const std::string kScene = test::struckBar("{quantity: velocity, at: bar, channel: 1}");

/// A hand that strikes a skin through all kinds of links and points that remember something.
std::string manyMatters() {
  std::string touches;
  for (int m = 0; m < 81; ++m) {
    touches += (m == 0 ? "" : ", ") + ("[t" + std::to_string(m)) + ", [stick, skin." +
               std::to_string(m / 9) + "." + std::to_string(m % 9) + "]]";
  }
  return R"(ergotic: 1
gestural_rate: 3150
parameters: {k: {value: 3000, range: [1000, 5000]}}
sections: {a: {medium: 1e-3}, keys: {rate: gestural}}
generators:
  - {type: mesh, name: skin, section: a, rows: 9, columns: 9, spacing: 0.02, mass: 1e-3, stiffness: $k}
mats:
  key: {type: slice, section: keys, coupling: smooth}
  g: {type: ground, section: a}
  stick: {type: mass, section: a, mass: 0.01, x: 0.002}
  one: {type: mass, section: a, mass: 1e-3}
  two: {type: mass, section: a, mass: 1e-3}
  three: {type: mass, section: a, mass: 1e-3}
  under: {type: point, along: skin, at: [0.5, 0.5], guide: [{mat: key, scale: 30}, {mat: stick, scale: 90}]}
  hair: {type: tap, of: [skin.3.3, skin.3.4, skin.4.3], weights: [0.5, 1, -0.3]}
lias:
  arm: {type: spring_damper, between: [key, stick], stiffness: 100, damping: 0.1}
  gut: {type: relaxing, between: [stick, g], stiffness: 30, material: gut}
  head: {type: felt, between: [under, stick], stiffness: 1e4, exponent: 1.5, damping: 0.3}
  bar: {type: bend, between: [one, two, three], weights: [1, -2, 1], stiffness: 2000, damping: 1e-4}
  left: {type: spring, between: [one, g], stiffness: 300}
  right: {type: spring, between: [three, g], stiffness: $k}
  press: {type: contact, between: [two, stick], stiffness: 400}
  rub: {type: friction, between: [two, hair], normal: press, steady: 0.3, parts: [[0.5, 0.05]]}
  tension: {type: stretch, of: skin, spacing: 0.02, hardening: 30}
  hard: {type: cubic, between: [one, two], stiffness: 0, nonlinearity: 1e8, tank: net}
  touch:
    with: {type: contact, stiffness: 100, threshold: -0.001, scheme: energy_stable}
    columns: [name, between]
    rows: [)" +
         touches + R"(]
ports: {hand: {mat: key, slice: 0}}
outputs: {o: {at: hair, quantity: velocity, channel: 1}}
)";
}

void write(rosbag::Bag& bag, const bag::Keyframe& keyframe) {
  ergotic::Keyframe message;
  message.tick = keyframe.tick;
  message.scene = keyframe.scene_text;
  message.scene_name = keyframe.scene_name;
  message.build = "0 another";
  message.audio_rate = keyframe.rates.audio_hz;
  message.ratio = static_cast<std::uint32_t>(keyframe.rates.ratio);
  message.precision = nameOf(keyframe.precision);
  message.isa = keyframe.isa;
  message.threads = static_cast<std::uint32_t>(keyframe.threads);
  message.metered = keyframe.metered;
  message.slices = static_cast<std::uint32_t>(keyframe.slices);
  message.state = keyframe.state;
  message.parameter_values = keyframe.parameters;
  bag.write("/station/keyframe", ros::Time(1, 0), message);
}

void write(rosbag::Bag& bag, const bag::Stretch& block) {
  ergotic::GestureBlock message;
  message.first_tick = block.first_tick;
  message.slices = static_cast<std::uint32_t>(block.slices);
  message.ticks = static_cast<std::uint32_t>(block.flags.size());
  message.flags = block.flags;
  message.positions = block.positions;
  message.ports = static_cast<std::uint32_t>(block.ports);
  message.port_positions = block.ports_at;
  bag.write("/station/gesture", ros::Time(1, 0), message);
}

void write(rosbag::Bag& bag, const station::Event& event) {
  ergotic::Event message;
  message.tick = event.tick;
  message.type = static_cast<std::uint8_t>(event.type);
  message.index = event.index;
  message.value = event.value;
  bag.write("/station/events", ros::Time(1, 0), message);
}

class RenderBagTest : public testing::Test {
 protected:
  RenderBagTest() : live_(kScene) { perform(live_); }
  ~RenderBagTest() override {
    std::remove(bag_path_.c_str());
    std::remove(sound_path_.c_str());
  }

  static void perform(LiveRun& live) {
    live.play(150);
    live.takeKeyframe();
    live.play(1000);
    live.setParameter(0, 4000.0);
    live.play(1000);
  }

  void record(std::optional<std::size_t> lost_block = std::nullopt) {
    record(live_.recording(), lost_block);
  }
  void record(const bag::Recording& recording, std::optional<std::size_t> lost_block) {
    rosbag::Bag bag(bag_path_, rosbag::bagmode::Write);
    for (std::size_t i = 0; i < recording.stretches.size(); ++i) {
      if (i != lost_block) {
        write(bag, recording.stretches[i]);
      }
    }
    for (const station::Event& event : recording.events) {
      write(bag, event);
    }
    for (const bag::Keyframe& keyframe : recording.keyframes) {
      write(bag, keyframe);
    }
  }

  Outcome render(const std::string& arguments = "") {
    return run("render", arguments + " --gesture " + bag_path_ + " --out " + sound_path_);
  }

  /// Samples that differ from the performance, from tick 150 on.
  std::size_t differences() { return differencesFrom(live_); }
  std::size_t differencesFrom(const LiveRun& live) {
    const std::vector<double> got = audio::WavReader(sound_path_).readAll();
    const std::vector<float> wanted(live.sound().begin() + 150 * LiveRun::kRates.ratio,
                                    live.sound().end());
    EXPECT_EQ(got.size(), wanted.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(got.size(), wanted.size()); ++i) {
      count += got[i] != static_cast<double>(wanted[i]) ? 1 : 0;
    }
    return count;
  }

  LiveRun live_;
  const test::ScratchFile name_;
  const std::string bag_path_ = name_.path() + ".bag";
  const std::string sound_path_ = name_.path() + ".wav";
};

TEST_F(RenderBagTest, GivesTheSamplesOfThePerformance) {
  record();
  const Outcome outcome = render();
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(differences(), 0U);
  EXPECT_THAT(outcome.text, HasSubstr("recorded by build 0 another"));
}

TEST_F(RenderBagTest, GivesTheSamplesOfAllMatterThatRemembers) {
  for (const physics::Precision precision :
       {physics::Precision::kFloat, physics::Precision::kDouble}) {
    physics::CompileOptions options(precision);
    options.metered = precision == physics::Precision::kDouble;
    LiveRun live(manyMatters(), options);
    perform(live);
    live.swap(manyMatters());
    live.play(500);
    live.takeKeyframe();
    live.play(500);
    record(live.recording(), std::nullopt);
    const Outcome outcome = render();
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(differencesFrom(live), 0U);
    const auto [low, high] = std::minmax_element(live.sound().begin(), live.sound().end());
    EXPECT_GT(*high - *low, 1e-3F);
  }
}

TEST_F(RenderBagTest, RefusesGapsUnlessTheyAreAllowed) {
  record(3);
  const Outcome refused = render();
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(
      refused.text,
      HasSubstr("the replay may differ from what was played: gap of 64 ticks at tick 192\n"));
  EXPECT_FALSE(test::exists(sound_path_));
  EXPECT_EQ(render("--allow-gaps").code, 0);
  EXPECT_GT(differences(), 0U);
}

TEST_F(RenderBagTest, PlaysTheScenesOfTheBagAndSaysIfAnotherWasNamed) {
  record();
  const test::ScratchFile same(kScene);
  EXPECT_THAT(render(same.path()).text, Not(HasSubstr("is not the scene")));
  const test::ScratchFile other(std::string(kScene) + "# changed\n");
  const Outcome outcome = render(other.path());
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.text, HasSubstr("is not the scene of the recording (live.yaml)"));
  EXPECT_EQ(differences(), 0U);
}

TEST_F(RenderBagTest, TakesRatesAndParametersFromTheRecordingOnly) {
  record();
  EXPECT_EQ(render("--rate 48000").code, 2);
  EXPECT_EQ(render("--set tone=3000").code, 2);
  EXPECT_EQ(render("--precision double").code, 2);
}

TEST_F(RenderBagTest, PlaysTheSameSamplesWithTheKernelsAndThreadsAskedFor) {
  record();
  const Outcome outcome = render("--isa baseline --threads 2");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.text, HasSubstr("(float, baseline, 2 threads)"));
  EXPECT_EQ(differences(), 0U);
  EXPECT_EQ(render("--isa avx4096").code, 2);
}

TEST_F(RenderBagTest, SaysWhatIsWrongWithADamagedBagAndHowToMendIt) {
  record();
  const std::string whole = test::textOf(bag_path_);
  const std::string mend = "`rosbag reindex " + bag_path_ + "`";
  const auto complaintOn = [&](const std::string& damaged) {
    std::ofstream(bag_path_, std::ios::binary) << damaged;
    const Outcome refused = render();
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.text, HasSubstr(mend));
    return refused.text;
  };
  std::string unindexed = whole;
  const std::string key = "index_pos=";
  unindexed.replace(unindexed.find(key) + key.size(), 8, 8, '\0');  // as while it is recorded
  EXPECT_THAT(complaintOn(unindexed), HasSubstr("has no index"));
  EXPECT_THAT(complaintOn(whole.substr(0, whole.size() / 2)), HasSubstr("ends too soon"));
  std::string holed = whole;
  holed.replace(whole.size() - 600, 500, 500, '\0');
  EXPECT_THAT(complaintOn(holed), HasSubstr("is damaged"));
}

TEST_F(RenderBagTest, SaysThatItLacksTheKernelsOfTheRecording) {
  record();
  EXPECT_THAT(render().text, Not(HasSubstr("lacks")));
  bag::Recording elsewhere = live_.recording();
  elsewhere.keyframes.at(0).isa = "avx4096";
  record(elsewhere, std::nullopt);
  const Outcome outcome = render();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.text, HasSubstr("note: recorded with kernels for avx4096, which this "
                                      "processor lacks"));
  EXPECT_EQ(differences(), 0U);
  EXPECT_THAT(render("--isa baseline").text, Not(HasSubstr("lacks")));
}

TEST_F(RenderBagTest, HasNoEnergiesToTellWhereNoEnergiesWereKept) {
  record();
  EXPECT_THAT(render("--energies").text, HasSubstr("balance_residual"));
  physics::CompileOptions without_energies;
  without_energies.metered = false;
  LiveRun unmetered(kScene, without_energies);
  perform(unmetered);
  record(unmetered.recording(), std::nullopt);
  EXPECT_EQ(render().code, 0);
  EXPECT_EQ(differences(), 0U);
  std::remove(sound_path_.c_str());
  const Outcome refused = render("--energies");
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.text, HasSubstr("without energy accounts"));
  EXPECT_FALSE(test::exists(sound_path_));
}

}  // namespace
}  // namespace ergotic
