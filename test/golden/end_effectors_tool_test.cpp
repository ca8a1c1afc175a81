// SPDX-License-Identifier: BSD-3-Clause
// End-effectors given to the command-line tools.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ergotic/audio/wav.hpp"
#include "support/scratch_file.hpp"
#include "support/struck_bar.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::Outcome;
using test::run;
using test::ScratchFile;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

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
    return run("check", scene_.path() + ".yaml --end-effectors " + file.path(), errors);
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
