// SPDX-License-Identifier: BSD-3-Clause
// What `check` says of those who play, and `render` of those who play by themselves.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ergotic/audio/wav.hpp"
#include "support/scratch_file.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::Outcome;
using test::run;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

const std::string kDuet = std::string(ERGOTIC_SOURCE_DIR) + "/models/duet.yaml";

TEST(PortToolsTest, CheckTellsPortsFromAgentsAndSaysWhatNoiseTheyBring) {
  const Outcome outcome = run("check", kDuet);
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
                       " --device-damping 6 --device-delay 0 --sensor-noise 3e-6 "
                       "--sensor-quantum 0");
  EXPECT_THAT(outcome.text, AllOf(HasSubstr("passive_up_to_n_per_m: 37800\n"),
                                  HasSubstr("noise: {position_m: 3e-06, ")));
  EXPECT_EQ(run("check", kDuet + " --device-damping 0").code, 2);
  EXPECT_EQ(run("check", kDuet + " --device-delay -1").code, 2);
}

/// A wall, N/m, and the port in front of it.
std::string wallOf(double stiffness, const std::string& port) {
  return "ergotic: 1\nname: wall\nsections:\n  hand: {rate: gestural}\nmats:\n"
         "  key: {type: slice, section: hand}\n"
         "  ground: {type: ground, section: hand, at: [0, 0]}\n"
         "lias:\n  wall: {type: spring_damper, between: [key, ground], damping: 0.5, stiffness: " +
         std::to_string(stiffness) + "}\nports:\n  key: " + port + "\n";
}

/// At 3150 Hz, where a slice of 2 N s/m bears 2 b / (3 T) = 4200 N/m.
/// \param errors  where stderr goes
Outcome checkOf(const std::string& scene,
                const std::string& options = "",
                const std::string& errors = "&1") {
  const test::ScratchFile place;
  const std::string path = place.path() + ".yaml";
  std::ofstream(path) << scene;
  Outcome outcome = run("check", path + " --gestural-rate 3150" + options, errors);
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
              ContainsRegex("^[^ ]*:11:3: error: port 'key' renders up to 9000 N/m at "
                            "its slice, which is passive up to 4200 N/m"));
}

TEST(PortToolsTest, CheckWarnsOfAPortBelowTwiceWhatItsSliceBears) {
  const test::ScratchFile errors;
  const Outcome warned = checkOf(wallOf(8000, "{mat: key, slice: 0}"), "", errors.path());
  EXPECT_EQ(warned.code, 0) << warned.text;
  EXPECT_THAT(warned.text, HasSubstr("warning: port 'key': the hand may meet 8000 N/m"));
  EXPECT_EQ(errors.text(), "");
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
  EXPECT_THAT(refused.text, HasSubstr(":11:3: error: port 'key' renders up to 9000 N/m"));
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
  const std::string drum = std::string(ERGOTIC_SOURCE_DIR) + "/models/drum";
  const std::string hands =
      " --end-effectors " + std::string(ERGOTIC_SOURCE_DIR) + "/config/hands.yaml";
  const Outcome checked = run("check", drum + ".yaml" + hands);
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

}  // namespace
}  // namespace ergotic
