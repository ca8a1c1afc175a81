// SPDX-License-Identifier: BSD-3-Clause
// `check --reach`, as a maker reads it, and what `check` says of slices that meet nothing.
#include "support/places.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::Outcome;
using test::run;

/// A plectrum below a string, a mallet too far from it, and a slice that was forgotten.
constexpr char kThreeHands[] =
    "ergotic: 1\n"
    "sections: {a: {rate: audio}, k: {rate: gestural}}\n"
    "mats:\n"
    "  pick: {type: slice, section: k, rest: -10 mm}\n"
    "  grip: {type: slice, section: k, rest: -45 mm}\n"
    "  head: {type: mass, section: a, mass: 20 g, x: -45 mm}\n"
    "  idle: {type: slice, section: k}\n"
    "generators:\n"
    "  - {type: string, name: s, section: a, masses: 40, pitch: A2, impedance: 0.2, t60: 4 s, to: "
    "[1, 0]}\n"
    "lias:\n"
    "  pluck: {type: pluck, between: [pick, s@0.2], stiffness: 1000, width: 4 mm}\n"
    "  shaft: {type: spring_damper, between: [grip, head], stiffness: 300, damping: 2}\n"
    "  hit: {type: felt, between: [head, s@0.2], stiffness: 1e6, exponent: 2, damping: 0.1}\n"
    "ports:\n"
    "  pick: {mat: pick, slice: 0}\n"
    "  mallet: {mat: grip, slice: 1}\n"
    "  idle: {mat: idle, slice: 2}\n"
    "outputs: {o: {at: s.5, quantity: velocity, channel: 1}}\n";

Outcome check(const std::string& options) {
  const test::ScratchFile place;
  const std::string path = place.path() + ".yaml";
  std::ofstream(path) << kThreeHands;
  const Outcome said = run("check", path + " " + options);
  std::remove(path.c_str());
  return said;
}

constexpr char kTooFar[] =
    ":16:3: warning: port 'mallet' (slice 1) meets nothing within its stroke of +-30 mm: the "
    "nearest, 's@0.2' (felt 'hit'), is at 45 mm of the hand. Let 'grip' rest nearer, or lower its "
    "position_scale";
constexpr char kForgotten[] = ":17:3: warning: port 'idle' (slice 2) can touch nothing: ";

TEST(CheckReachTest, TellsWhatEachSliceMeetsAndWhereInItsStroke) {
  const Outcome said = check("--reach");
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_THAT(said.text, AllOf(HasSubstr("stroke_m: [-0.03, 0.03]\n"),
                               HasSubstr("meets_first: s@0.2 (pluck) at 6 mm\n"),
                               HasSubstr("at_m: 0.006, of_stroke: 0.2, until_m: 0.014}\n"),
                               HasSubstr("meets_first: nothing within its stroke of +-30 mm\n"),
                               HasSubstr("not_within_its_stroke:\n"), HasSubstr("carries: head\n"),
                               HasSubstr("meets_first: nothing (no link leads to anything)"),
                               HasSubstr(kTooFar), HasSubstr(kForgotten)));
}

TEST(CheckReachTest, OnALargerDeviceItIsWithinTheStroke) {
  const Outcome said = check("--reach --device-stroke 0.05");
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_THAT(said.text,
              AllOf(HasSubstr("meets_first: s@0.2 (felt) at 45 mm\n"), HasSubstr("at_m: 0.045"),
                    HasSubstr("of_stroke: 0.9"), Not(HasSubstr("port 'mallet'"))));
}

TEST(CheckReachTest, CheckSaysOnlyWhatIsWrong) {
  const Outcome said = check("");
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_THAT(said.text,
              AllOf(HasSubstr(kTooFar), HasSubstr(kForgotten), Not(HasSubstr("'pick'"))));
}

TEST(CheckReachTest, TellsTheCoordinatesOfEndEffectors) {
  const Outcome said = run("check", repository("models/drum.yaml") + " --reach --end-effectors " +
                                        repository("models/hands/drum.yaml"));
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_THAT(said.text, AllOf(HasSubstr("slices: none\n"),
                               HasSubstr("end_effector: mallet\n    port: mallet_z"),
                               HasSubstr("meets_first: skin.7.7 (power-law contact) at -8 mm\n"),
                               HasSubstr("meets_first: nothing on its way\n")));
}

TEST(CheckReachTest, TellsHowFarNotesMoveEachSlice) {
  const Outcome said = run("check", repository("models/harmonics.yaml") + " --reach");
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_THAT(said.text, AllOf(HasSubstr("meets_first: touched (contact) at 4 mm\n"),
                               HasSubstr("notes_move_it_to_m: [0.007]\n"),
                               HasSubstr("meets_first: nothing (it leads touched along string)\n"),
                               Not(HasSubstr("notes_meet"))));
}

}  // namespace
}  // namespace ergotic
