// SPDX-License-Identifier: BSD-3-Clause
// How the tools take precision, instruction set, threads and end-effectors, how `check --target`
// proposes and `render --target` applies, and what they say of those who play.

#include <cstdio>

#include "ergotic/audio/wav.hpp"
#include "ergotic/rt/isa.hpp"
#include "support/places.hpp"
#include "support/scratch_file.hpp"
#include "support/struck_bar.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::Outcome;
using test::run;
using test::ScratchFile;
using testing::ContainsRegex;

const std::string kString = repository("models/string.yaml");
const std::string kPluck = repository("models/string_demo.csv");

std::vector<double> playString(const std::string& options) {
  const test::ScratchFile sound;
  const Outcome outcome = run("render", kString + " --gesture " + kPluck + " --seconds 2.5 --out " +
                                            sound.path() + " " + options);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  return audio::WavReader(sound.path()).readAll();
}

TEST(ToolOptionsTest, AScenePlaysTheSameSamplesWithAnyKernelsThreadsAndEnergies) {
  const std::vector<double> wanted = playString("");
  EXPECT_TRUE(std::any_of(wanted.begin(), wanted.end(), [](double s) { return s > 0.01; }));
  for (const rt::Isa isa : rt::isas()) {
    EXPECT_EQ(playString(std::string("--isa ") + nameOf(isa)), wanted) << nameOf(isa);
  }
  EXPECT_EQ(playString("--threads 2"), wanted);
  EXPECT_EQ(playString("--energies"), wanted);
  EXPECT_NE(playString("--precision double"), wanted);
}

TEST(ToolOptionsTest, AShippedInstrumentIsAskedForByItsName) {
  EXPECT_EQ(run("expand", "string").text, run("expand", kString).text);
  const Outcome none = run("render", "strings --seconds 0.1");
  EXPECT_NE(none.code, 0);
  EXPECT_THAT(none.text, HasSubstr("strings: cannot be read"));
}

TEST(ToolOptionsTest, RenderSaysWhatPlayed) {
  EXPECT_THAT(run("render", kString + " --seconds 0.1").text,
              HasSubstr(std::string("(float, ") + nameOf(rt::bestIsa()) + ", 1 thread)"));
  EXPECT_THAT(
      run("render", kString + " --seconds 0.1 --precision double --isa baseline --threads 2").text,
      HasSubstr("(double, baseline, 2 threads)"));
}

TEST(ToolOptionsTest, CheckSaysWhatTheSceneIsCompiledToAndWhatThatCosts) {
  EXPECT_THAT(run("check", kString + " --verbose --isa baseline --threads 2").text,
              AllOf(HasSubstr("program:\n  precision: float\n  isa: baseline\n  threads: 2\n"),
                    HasSubstr("    - section 'string': "), HasSubstr("cost:\n  float: {")));
  EXPECT_THAT(run("check", kString + " --verbose --precision double").text,
              HasSubstr("program:\n  precision: double\n"));
}

TEST(ToolOptionsTest, WhatCannotBeIsRefusedWithWhatCan) {
  for (const char* tool : {"render", "check"}) {
    const Outcome isa = run(tool, kString + " --isa sse9");
    EXPECT_EQ(isa.code, 2);
    EXPECT_THAT(isa.text, AllOf(HasSubstr("--isa"), HasSubstr("'sse9'"), HasSubstr("baseline"),
                                HasSubstr(nameOf(rt::bestIsa()))));
    for (const char* threads : {"0", "9", "-1", "two"}) {
      const Outcome refused = run(tool, kString + " --threads " + threads);
      EXPECT_EQ(refused.code, 2) << threads;
      EXPECT_THAT(refused.text, AllOf(HasSubstr("--threads"), HasSubstr(threads)));
    }
    EXPECT_EQ(run(tool, kString + " --precision half").code, 2);
  }
}

const std::string kFretted = repository("models/fretted_string.yaml");

TEST(TargetOptionTest, CheckExplainsTheProposalPartByPart) {
  const Outcome outcome = run("check", kString + " --target '1 cent'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text,
              AllOf(HasSubstr("\ntarget:\n  asked: 1 cent\n  reached: yes\n"),
                    HasSubstr("part: string 'string'"), HasSubstr("worst of ten partials"),
                    HasSubstr("now: 0.967 cents"), HasSubstr("steps_per_s: {now: "),
                    HasSubstr("cpu_percent: {now: "), HasSubstr("chaplet 'plectrum'")));
  EXPECT_THAT(run("check", kString).text, Not(HasSubstr("target:")));
}

TEST(TargetOptionTest, RenderPlaysTheProposalAndSaysWhatItChanged) {
  const test::ScratchFile sound;
  const Outcome outcome =
      run("render", kString + " --target '1 cent' --seconds 0.5 --out " + sound.path());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text,
              AllOf(HasSubstr("target 1 cent: 22050 Hz"), HasSubstr("160 masses -> 20 masses"),
                    HasSubstr("22050 Hz, gestures 3150 Hz (R = 7)")));
  EXPECT_EQ(audio::WavReader(sound.path()).sampleRate(), 22050.0);
}

TEST(TargetOptionTest, RatesThatAreGivenAreKept) {
  const Outcome outcome = run(
      "render", kFretted + " --target '2 cents' --rate 48000 --gestural-rate 3000 --seconds 0.1");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("48000 Hz, gestures 3000 Hz (R = 16)"));
}

TEST(TargetOptionTest, BadTargetsAreRefusedWithWhatIsAllowed) {
  for (const char* tool : {"check", "render"}) {
    const Outcome outcome = run(tool, kString + " --target '1 furlong'");
    EXPECT_EQ(outcome.code, 1) << tool;
    EXPECT_THAT(outcome.text, AllOf(HasSubstr("'1 furlong'"), HasSubstr("cent"), HasSubstr("dB")));
  }
}

const std::string kDuet = repository("models/duet.yaml");

TEST(PortToolsTest, CheckTellsPortsFromAgentsAndSaysWhatNoiseTheyBring) {
  const Outcome outcome = run("check", kDuet + " --verbose");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(
      outcome.text,
      AllOf(HasSubstr("findings: none"), HasSubstr("warnings: none"),
            HasSubstr("  - name: damper\n    module: damper_key\n    axis: x\n    slice: 0\n"),
            HasSubstr("noise: {position_m: 5.7735e-07, force_n: "), HasSubstr("behind_filter_m: "),
            HasSubstr("agents:\n  - name: plucker\n    axis: x\n    module: thumb\n"
                      "    stiffness_n_per_m: 1500\n    damping_n_s_per_m: 12\n    points: 6\n"
                      "    ends_s: 1\n    period_s: 1\n")));
  EXPECT_THAT(outcome.text, Not(HasSubstr("name: plucker.target")));
}

TEST(PortToolsTest, CheckIsForTheDeviceThatIsAskedFor) {
  const Outcome outcome =
      run("check", kDuet +
                       " --verbose --device-damping 6 --device-delay 0 --sensor-noise 3e-6 "
                       "--sensor-quantum 0");
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("passive_up_to_n_per_m: 9450\n"),
                                  HasSubstr("noise: {position_m: 3e-06, ")));
  EXPECT_EQ(run("check", kDuet + " --device-damping 0").code, 2);
  EXPECT_EQ(run("check", kDuet + " --device-delay -1").code, 2);
}

/// A wall, N/m, its damper, N s/m, and the port in front of it.
std::string wallOf(double stiffness, const std::string& port, double damping = 0.5) {
  return "ergotic: 1\nname: wall\nsections:\n  hand: {rate: gestural}\nmats:\n"
         "  key: {type: slice, section: hand}\n"
         "  ground: {type: ground, section: hand, at: [0, 0]}\n"
         "lias:\n  wall: {type: spring_damper, between: [key, ground], damping: " +
         std::to_string(damping) + ", stiffness: " + std::to_string(stiffness) +
         "}\nports:\n  key: " + port + "\n";
}

/// At 3150 Hz, where a slice of 2 N s/m bears 2 b / (3 T) = 4200 N/m.
/// \param errors  where stderr goes
Outcome checkOf(const std::string& scene,
                const std::string& options = "",
                const std::string& errors = "&1") {
  const test::ScratchFile place;
  const std::string path = place.path() + ".yaml";
  std::ofstream(path) << scene;
  Outcome outcome = run("check", path + " --verbose --gestural-rate 3150" + options, errors);
  std::remove(path.c_str());
  return outcome;
}

TEST(PortToolsTest, CheckRefusesAPortAboveTwiceWhatItsSliceBears) {
  const test::ScratchFile errors;
  const Outcome refused = checkOf(wallOf(9000, "{mat: key, slice: 0}"), "", errors.path());
  EXPECT_EQ(refused.code, 1) << refused.text;
  EXPECT_THAT(refused.text, AllOf(HasSubstr("stiffness_n_per_m: 9000\n"),
                                  HasSubstr("passive_up_to_n_per_m: 4200\n")));
  EXPECT_THAT(errors.text(),
              ContainsRegex("^[^ ]*:11:3: error: port 'key': the hand may meet 9000 N/m, mostly by "
                            "link 'wall'; .* is passive up to 4200 N/m"));
}

TEST(PortToolsTest, CheckWarnsOfAPortBelowTwiceWhatItsSliceBears) {
  const test::ScratchFile errors;
  const Outcome warned = checkOf(wallOf(8000, "{mat: key, slice: 0}"), "", errors.path());
  EXPECT_EQ(warned.code, 0) << warned.text;
  EXPECT_THAT(warned.text, HasSubstr("warning: port 'key': the hand may meet 8000 N/m"));
  EXPECT_EQ(errors.text(), "");
}

TEST(PortToolsTest, CheckRefusesADamperThatSetsTheSliceOff) {
  const test::ScratchFile errors;
  const std::string brake = wallOf(0.0, "{mat: key, slice: 0}", 5000.0);
  const Outcome refused = checkOf(brake, "", errors.path());
  EXPECT_EQ(refused.code, 1) << refused.text;
  EXPECT_THAT(refused.text,
              AllOf(HasSubstr("verdict: unproven"), HasSubstr("damping_n_s_per_m: 5000\n"),
                    HasSubstr("passive_up_to_n_s_per_m: 773.")));
  EXPECT_THAT(errors.text(), ContainsRegex("^[^ ]*:11:3: error: port 'key': the hand may meet 5000 "
                                           "N s/m, mostly by link 'wall'; a slice of 0.3 kg .* "
                                           "bears up to 773.4 N s/m"));
  EXPECT_EQ(checkOf(brake, " --device-mass 5").code, 0);
}

TEST(PortToolsTest, CheckRefusesByTheDeviceThatIsAskedFor) {
  const std::string wall = wallOf(9000, "{mat: key, slice: 0}");
  EXPECT_EQ(checkOf(wall, " --device-damping 3").code, 0);
  EXPECT_EQ(checkOf(wallOf(8000, "{mat: key, slice: 0}"), " --device-delay 2").code, 1);
}

TEST(PortToolsTest, CheckRefusesByTheScalesOfThePortAndNoneThatNoSliceMoves) {
  EXPECT_EQ(checkOf(wallOf(9000, "{mat: key, slice: 0, force_scale: 0.5}")).code, 0);
  EXPECT_EQ(checkOf(wallOf(9000, "{mat: key}")).code, 0);
}

TEST(PortToolsTest, CheckJudgesAPortThatAnEndEffectorTakesThroughThatAlone) {
  const std::string wall = wallOf(9000, "{mat: key, slice: 0}");
  const std::string file =
      "end_effectors:\n  soft: {type: key, slices: 1, force_scale: 0.5, ports: ";
  const test::ScratchFile takes_it(file + "key}\n");
  EXPECT_EQ(checkOf(wall, " --end-effectors " + takes_it.path()).code, 0);
  const test::ScratchFile leaves_it(file + "''}\n");
  const Outcome refused = checkOf(wall, " --end-effectors " + leaves_it.path());
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.text, HasSubstr(":11:3: error: port 'key': the hand may meet 9000 N/m"));
}

double peakBetween(const std::vector<double>& stereo, double from_s, double to_s) {
  const auto frame = [](double s) { return static_cast<std::size_t>(s * 44100.0); };
  double peak = 0.0;
  for (std::size_t n = frame(from_s); n < frame(to_s); ++n) {
    peak = std::max(peak, std::abs(stereo.at(2 * n)));
  }
  return peak;
}

TEST(PortToolsTest, ABallStrikesTheDrumAndAHandleMutesIt) {
  const std::string drum = repository("models/drum");
  const std::string hands = " --end-effectors " + repository("config/hands.yaml");
  const Outcome checked = run("check", drum + ".yaml --verbose" + hands);
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_THAT(checked.text, AllOf(HasSubstr("findings: none"), HasSubstr("warnings: none")));
  const test::ScratchFile sound;
  const Outcome played = run("render", drum + ".yaml" + hands + " --gesture " + drum +
                                           "_demo.csv --seconds 2.7 --out " + sound.path());
  ASSERT_EQ(played.code, 0) << played.text;
  const std::vector<double> heard = audio::WavReader(sound.path()).readAll();
  EXPECT_EQ(peakBetween(heard, 0.0, 0.25), 0.0);
  EXPECT_GT(peakBetween(heard, 0.3, 0.4), 0.1);
  const double open = peakBetween(heard, 1.3, 1.45) / peakBetween(heard, 0.9, 1.0);
  const double muted = peakBetween(heard, 2.5, 2.65) / peakBetween(heard, 2.1, 2.2);
  EXPECT_LT(muted, 0.7 * open);
}

TEST(PortToolsTest, AnAgentPlaysOnceASecondWithoutAPlayer) {
  const test::ScratchFile sound;
  const Outcome outcome = run("render", kDuet + " --seconds 2.2 --out " + sound.path());
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const std::vector<double> frames = audio::WavReader(sound.path()).readAll();
  EXPECT_LT(peakBetween(frames, 0.0, 0.2), 1e-6);
  EXPECT_GT(peakBetween(frames, 0.2, 0.7), 0.02);
  EXPECT_GT(peakBetween(frames, 1.2, 1.7), 0.02);
  EXPECT_LT(peakBetween(frames, 0.0, 2.2), 1.0);
}

/// The bar's slice on a lever of 2 on slice 1.
std::string keyOf(const std::string& more) {
  return "devices: [{driver: virtual}]\nend_effectors:\n  mallet: {type: key, slices: 1, "
         "ports: hand, lever: 2" +
         more + "}\n";
}

class EndEffectorsToolTest : public testing::Test {
 protected:
  /// \param columns  of the slices, before the one that moves
  /// \param step     of that one, m per tick, after 100 ticks
  std::vector<double> soundOf(const std::string& head,
                              const std::string& columns,
                              double step,
                              const std::string& options) {
    std::string text = head + "\n";
    for (int tick = 0; tick < 315; ++tick) {
      text += std::to_string(tick) + columns + "," +
              std::to_string(step * std::max(0, tick - 100)) + "\n";
    }
    const ScratchFile moves(text);
    const ScratchFile out;
    const Outcome outcome = run("render", scene_.path() + ".yaml --out " + out.path() +
                                              " --gesture " + moves.path() + options);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return audio::WavReader(out.path()).readAll();
  }

  void SetUp() override { std::rename(scene_.path().c_str(), (scene_.path() + ".yaml").c_str()); }
  void TearDown() override { std::remove((scene_.path() + ".yaml").c_str()); }

  Outcome check(const std::string& end_effectors, const std::string& errors = "&1") {
    const ScratchFile file(end_effectors);
    return run("check", scene_.path() + ".yaml --verbose --end-effectors " + file.path(), errors);
  }

  ScratchFile scene_{test::struckBar("{quantity: position, at: bar, channel: 1, gain: 100}")};
};

TEST_F(EndEffectorsToolTest, RenderPlaysThroughThem) {
  const ScratchFile file(keyOf(""));
  const std::vector<double> direct = soundOf("tick,x0", "", 4e-5, "");
  const std::vector<double> through =
      soundOf("tick,x0,x1", ",0", 2e-5, " --end-effectors " + file.path());
  double peak = 0.0;
  for (const double sample : direct) {
    peak = std::max(peak, std::abs(sample));
  }
  EXPECT_GT(peak, 1e-3);
  EXPECT_EQ(direct, through);
}

TEST_F(EndEffectorsToolTest, RenderLeavesTheModelAloneWhereNobodyHoldsThem) {
  const ScratchFile file(keyOf(""));
  const Outcome outcome =
      run("render", scene_.path() + ".yaml --seconds 0.1 --end-effectors " + file.path());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text, HasSubstr("peak 0,"));
}

TEST_F(EndEffectorsToolTest, RenderSaysWhereAConfigurationIsWrong) {
  const ScratchFile file("end_effectors:\n  mallet: {type: key, slices: 1, ports: hands}\n");
  const Outcome outcome = run("render", scene_.path() + ".yaml --end-effectors " + file.path());
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text,
              HasSubstr(file.path() + ":2:3: error: end-effector 'mallet': the scene has no port "
                                      "'hands'; did you mean 'hand'?"));
  EXPECT_EQ(run("render", scene_.path() + ".yaml --end-effectors /nowhere.yaml").code, 1);
}

TEST_F(EndEffectorsToolTest, RenderSaysSoWhenOneLeavesItsWorkspace) {
  const ScratchFile file(
      "end_effectors:\n  stick: {type: stick, slices: [0, 1], ports: [hand, ''], arm: 0.02}\n");
  std::string text = "tick,x0,x1\n";
  for (int tick = 0; tick < 315; ++tick) {
    text += std::to_string(tick) + "," + std::to_string(2e-4 * tick) + ",0\n";
  }
  const ScratchFile moves(text);
  const Outcome outcome = run("render", scene_.path() + ".yaml --end-effectors " + file.path() +
                                            " --gesture " + moves.path());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  // x = 0.02 tan(60 degrees) at tick 174 of 3150 Hz
  EXPECT_THAT(outcome.text, HasSubstr("warning: no force from 0.0552"));
  EXPECT_THAT(outcome.text, HasSubstr("an end-effector is where its linkage cannot be"));
}

TEST_F(EndEffectorsToolTest, CheckPrintsTheStiffnessOfEachSlice) {
  const Outcome outcome = check(keyOf(""));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  // 500 N/m behind a lever of 2; 2 b / (3 T) = 4200 N/m
  EXPECT_THAT(outcome.text, HasSubstr("slice: 1"));
  EXPECT_THAT(outcome.text, HasSubstr("end_effector: mallet"));
  EXPECT_THAT(outcome.text, HasSubstr("together_n_per_m: 2000"));
  EXPECT_THAT(outcome.text, HasSubstr("passive_up_to_n_per_m: 4200"));
  EXPECT_THAT(outcome.text, HasSubstr("\nslice_findings: none\n"));
  EXPECT_THAT(outcome.text, Not(HasSubstr("renders up to")));
}

TEST_F(EndEffectorsToolTest, CheckWarnsAboveHalfTheLimitAndRefusesAboveTwice) {
  const Outcome warned = check(keyOf(", force_scale: 1.1"));
  EXPECT_EQ(warned.code, 0) << warned.text;
  EXPECT_THAT(warned.text,
              HasSubstr(":3:3: warning: end-effector 'mallet' renders up to 2200 N/m"));
  const Outcome refused = check(keyOf(", force_scale: 5"));
  EXPECT_EQ(refused.code, 1) << refused.text;
  EXPECT_THAT(refused.text,
              HasSubstr(":3:3: error: end-effector 'mallet' renders up to 10000 N/m"));
}

TEST_F(EndEffectorsToolTest, CheckReportsWhatSlicesMeetTooMuchAndEndsWithWhatIsRefused) {
  const ScratchFile errors;
  const Outcome warned = check(keyOf(", force_scale: 1.1"), errors.path());
  EXPECT_THAT(warned.text, ContainsRegex("\nslice_findings:\n  - [^ ]*:3:3: warning: "));
  EXPECT_EQ(errors.text(), "");
  const Outcome refused = check(keyOf(", force_scale: 5"), errors.path());
  EXPECT_THAT(refused.text, ContainsRegex("\nslice_findings:\n  - [^ ]*:3:3: error: "));
  EXPECT_THAT(errors.text(), ContainsRegex("^[^ ]*:3:3: error: end-effector 'mallet' renders"));
}

}  // namespace
}  // namespace ergotic
