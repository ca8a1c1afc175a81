// SPDX-License-Identifier: BSD-3-Clause
// `check --target` proposes, `render --target` applies.
#include <string>

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
using testing::HasSubstr;
using testing::Not;

const std::string kString = std::string(ERGOTIC_SOURCE_DIR) + "/models/string.yaml";
const std::string kFretted = std::string(ERGOTIC_SOURCE_DIR) + "/models/fretted_string.yaml";

TEST(TargetOptionTest, CheckExplainsTheProposalPartByPart) {
  const Outcome outcome = run("check", kString + " --target '1 cent'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_THAT(outcome.text,
              AllOf(HasSubstr("\ntarget:\n  asked: 1 cent\n  reached: yes\n"),
                    HasSubstr("part: string 'string'"), HasSubstr("worst of ten partials"),
                    HasSubstr("now: 0.949 cents"), HasSubstr("steps_per_s: {now: "),
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

}  // namespace
}  // namespace ergotic
