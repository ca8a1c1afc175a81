// SPDX-License-Identifier: BSD-3-Clause
// `check --advise`, as a maker reads it.
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::Outcome;
using test::run;

/// A string that a stiff bridge pulls up, and one without losses.
constexpr char kTwoStrings[] =
    "ergotic: 1\n"
    "parameters: {bridge: {value: 2000, range: [0, 4000]}}\n"
    "sections: {a: {rate: audio}}\n"
    "mats: {wall: {type: ground, section: a}}\n"
    "generators:\n"
    "  - {type: string, name: low, section: a, masses: 80, pitch: A2, impedance: 0.2, t60: [[1, 4 "
    "s], [10, 1 s]], to: [1, 0]}\n"
    "  - {type: string, name: high, section: a, masses: 40, mass: 1e-5, frequency: 440, to: [1, "
    "0]}\n"
    "lias:\n"
    "  saddle: {type: spring, between: [low.1, wall], stiffness: $bridge}\n"
    "outputs: {o: {at: low.5, quantity: velocity, channel: 1}}\n";

Outcome advise(const std::string& options) {
  const test::ScratchFile place;
  const std::string path = place.path() + ".yaml";
  std::ofstream(path) << kTwoStrings;
  const Outcome said = run("check", path + " --advise " + options);
  std::remove(path.c_str());
  return said;
}

TEST(CheckAdviceTest, TellsWhatIsSharpWhatPullsItAndWhatPutsItRight) {
  const Outcome said = advise("");
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_THAT(said.text, AllOf(HasSubstr("'low' sounds "),
                               HasSubstr(" cents sharp of 110 Hz: 'saddle' pulls it by about "),
                               HasSubstr("in tune with bridge = 0, or ask for 109."),
                               HasSubstr("'high': rings without end"), HasSubstr("percent: 100")));
}

TEST(CheckAdviceTest, WishesAreAnsweredByEachParameter) {
  const Outcome said =
      advise("--wish 'pitch low 110.2 Hz' --wish 'pitch low B2' --wish 'pitch high 441'");
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_THAT(said.text, AllOf(HasSubstr("parameter: bridge"), HasSubstr("to: "),
                               HasSubstr("to: not within its range"),
                               HasSubstr("none of the scene changes it")));
}

TEST(CheckAdviceTest, WishesThatCannotBeReadAreRefusedWithWhatIsAllowed) {
  for (const char* const wish :
       {"loudness low 3", "pitch low", "pitch low -3 Hz", "margin 2", "t60 low 3 m"}) {
    const Outcome said = advise("--wish '" + std::string(wish) + "'");
    EXPECT_EQ(said.code, 1) << said.text;
    EXPECT_THAT(said.text, AllOf(HasSubstr("--wish '" + std::string(wish) + "': "),
                                 HasSubstr("allowed: 'pitch BODY 441 Hz'")));
  }
  EXPECT_THAT(advise("--wish 'pitch drum 441'").text, HasSubstr("no body 'drum' asks for a pitch"));
}

}  // namespace
}  // namespace ergotic
