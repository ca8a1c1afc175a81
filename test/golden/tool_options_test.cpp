// SPDX-License-Identifier: BSD-3-Clause
// How the tools take precision, instruction set and threads.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ergotic/audio/wav.hpp"
#include "ergotic/rt/isa.hpp"
#include "support/scratch_file.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::Outcome;
using test::run;
using testing::AllOf;
using testing::HasSubstr;

const std::string kString = std::string(ERGOTIC_SOURCE_DIR) + "/models/string.yaml";
const std::string kPluck = std::string(ERGOTIC_SOURCE_DIR) + "/models/string_demo.csv";

std::vector<double> play(const std::string& options) {
  const test::ScratchFile sound;
  const Outcome outcome = run("render", kString + " --gesture " + kPluck + " --seconds 2.5 --out " +
                                            sound.path() + " " + options);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  return audio::WavReader(sound.path()).readAll();
}

TEST(ToolOptionsTest, AScenePlaysTheSameSamplesWithAnyKernelsThreadsAndBooks) {
  const std::vector<double> wanted = play("");
  EXPECT_TRUE(std::any_of(wanted.begin(), wanted.end(), [](double s) { return s > 0.01; }));
  for (const rt::Isa isa : rt::isas()) {
    EXPECT_EQ(play(std::string("--isa ") + nameOf(isa)), wanted) << nameOf(isa);
  }
  EXPECT_EQ(play("--threads 2"), wanted);
  EXPECT_EQ(play("--energies"), wanted);
  EXPECT_NE(play("--precision double"), wanted);
}

TEST(ToolOptionsTest, RenderSaysWhatPlayed) {
  EXPECT_THAT(run("render", kString + " --seconds 0.1").text,
              HasSubstr(std::string("(float, ") + nameOf(rt::bestIsa()) + ", 1 thread)"));
  EXPECT_THAT(
      run("render", kString + " --seconds 0.1 --precision double --isa baseline --threads 2").text,
      HasSubstr("(double, baseline, 2 threads)"));
}

TEST(ToolOptionsTest, CheckSaysWhatTheSceneIsCompiledToAndWhatThatCosts) {
  EXPECT_THAT(run("check", kString + " --isa baseline --threads 2").text,
              AllOf(HasSubstr("program:\n  precision: float\n  isa: baseline\n  threads: 2\n"),
                    HasSubstr("    - section 'string': "), HasSubstr("cost:\n  float: {")));
  EXPECT_THAT(run("check", kString + " --precision double").text,
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

}  // namespace
}  // namespace ergotic
