// SPDX-License-Identifier: BSD-3-Clause
// What scenes claim, played and measured, against closed forms and against what is false.
#include "tools/lib/truths.hpp"

#include "support/places.hpp"
#include "support/scene_builder.hpp"
#include "support/scratch_file.hpp"
#include "support/tool_process.hpp"

namespace ergotic::tools {
namespace {

using test::kRates;

const std::string kScene = R"(ergotic: 1
sections: {a: {rate: audio}, k: {rate: gestural}}
mats:
  key: {type: slice, section: k}
  wall: {type: ground, section: k, x: 0.005}
  ball: {type: mass, section: a, mass: 0.01, x: 0.001, v: -1}
  anvil: {type: ground, section: a}
generators:
  - {type: string, name: s, section: a, masses: 80, mass: 2e-5, frequency: 220, loss: 1e-4, to: [0.65, 0]}
lias:
  stop: {type: contact, between: [key, wall], stiffness: 1000}
  hit: {type: contact, between: [anvil, ball], stiffness: 1e4}
ports: {p: {mat: key, slice: 0}}
outputs: {out: {at: s@0.13, quantity: velocity, channel: 1}}
truths:
)";

/// The one that a line of YAML states.
JudgedTruth judged(const std::string& truth) {
  const scene::ClaimingScene claims =
      scene::readTruths(kScene + "  - {" + truth + "}\n", "truths.yaml");
  return judgeTruths(claims, kRates, physics::Precision::kDouble).at(0);
}

const std::string kPluck = ", of: out, play: {pluck: 1 N, at: s@0.2}, ";

TEST(TruthsTest, HoldWhereTheyAreTrueAndNotWhereTheyAreNot) {
  EXPECT_TRUE(judged("what: pitch" + kPluck + "expect: A3, within: 0.1 cents").holds);
  EXPECT_FALSE(judged("what: pitch" + kPluck + "expect: 220.1, within: 0.5 cents").holds);
  EXPECT_TRUE(judged("what: pitch" + kPluck + "near: A3, least: 219, most: 221").holds);
  EXPECT_FALSE(judged("what: pitch" + kPluck + "near: A3, least: 221").holds);
  EXPECT_TRUE(judged("what: partials" + kPluck + "pitch: A3, to: 4, within: 3 cents").holds);
  EXPECT_FALSE(
      judged("what: partials" + kPluck + "pitch: A3, to: 4, inharmonicity: 1e-3, within: 3 cents")
          .holds);
}

const char* const kNotes = R"(ergotic: 1
sections: {a: {rate: audio}}
define:
  note:
    params: {pitch: {unit: Hz, default: A3}}
    needs: {s: audio}
    generators:
      - {type: string, name: body, section: s, masses: 80, mass: 2e-5, frequency: =pitch, loss: 1e-4, to: [0.65, 0]}
    outputs: {out: {at: body@0.13, quantity: velocity, channel: 1}}
    truths:
      - {what: pitch, of: out, play: {pluck: 1 N, at: body@0.2}, expect: =pitch, within: 0.1 cents}
use:
  - {is: note, as: high, in: {s: a}}
  - {is: note, as: low, in: {s: a}, with: {pitch: A2}}
truths:
  - {what: energy, play: {pluck: 1 N, at: low.body@0.2}, most: 1e-6}
)";

TEST(TruthsTest, OfADefinitionAreClaimedOfEachInstance) {
  const scene::ClaimingScene claims = scene::readTruths(kNotes, "notes.yaml");
  const auto judged = judgeTruths(claims, kRates, physics::Precision::kDouble);
  ASSERT_EQ(judged.size(), 3U);
  for (const JudgedTruth& one : judged) {
    EXPECT_TRUE(one.holds) << one.trouble;
  }
  EXPECT_NEAR(judged[1].measured.at(0), 220.0, 0.02);
  EXPECT_NEAR(judged[2].measured.at(0), 110.0, 0.01);
}

/// M/Z of a loss to the ground: T60 = 2 ln(1000) M/Z.
TEST(TruthsTest, TellTheDecayOfALossToTheGround) {
  const double t60 = 2.0 * std::log(1000.0) * 2e-5 / 1e-4;
  const JudgedTruth line = judged("what: t60" + kPluck + "near: A3, least: 0.1, seconds: 3");
  EXPECT_NEAR(line.measured.at(0), t60, 2e-3 * t60) << line.trouble;
  const JudgedTruth all = judged("what: t60" + kPluck + "least: 0.1, seconds: 3");
  EXPECT_NEAR(all.measured.at(0), t60, 5e-3 * t60) << all.trouble;
}

/// Plucked at a fifth of its length it has no fifth partial.
TEST(TruthsTest, TellWhichHarmonicsAreLeft) {
  EXPECT_TRUE(
      judged("what: harmonics_left" + kPluck + "pitch: A3, to: 9, divisible_by: 5, most: -40 dB")
          .holds);
  EXPECT_FALSE(
      judged("what: harmonics_left" + kPluck + "pitch: A3, to: 9, divisible_by: 2, most: -40 dB")
          .holds);
}

/// Half a period of K and M, and v sqrt(K M).
TEST(TruthsTest, TellHowLongAndHowHardSomethingStrikes) {
  const JudgedTruth duration = judged("what: contact, of: hit, figure: duration, most: 1");
  ASSERT_FALSE(duration.measured.empty()) << duration.trouble;
  EXPECT_NEAR(duration.measured[0], M_PI * std::sqrt(0.01 / 1e4), 1e-2 * M_PI * 1e-3);
  const JudgedTruth peak = judged("what: contact, of: hit, figure: peak, most: 100");
  ASSERT_FALSE(peak.measured.empty()) << peak.trouble;
  EXPECT_NEAR(peak.measured[0], std::sqrt(1e4 * 0.01), 1e-2 * 10.0);
}

TEST(TruthsTest, TellWhatAHandFeels) {
  EXPECT_TRUE(judged("what: force, of: p, figure: stiffness, expect: 1 kN/m, within: 0.1 %").holds);
  EXPECT_TRUE(judged("what: force, of: p, figure: work, expect: 112.5 mJ, within: 0.1 %").holds);
  EXPECT_TRUE(judged("what: force, of: p, figure: peak, expect: 15 N, within: 0.1 %").holds);
  EXPECT_FALSE(judged("what: force, of: p, figure: peak, expect: 15 N, within: 0.1 %, "
                      "travel: 0.01")
                   .holds);
  EXPECT_THAT(judged("what: force, of: p, figure: release, expect: 15 N, within: 1 %").trouble,
              HasSubstr("nothing lets go"));
}

TEST(TruthsTest, TellSilenceAndTheBalance) {
  EXPECT_TRUE(judged("what: silence" + kPluck + "after: 2.8 s, most: -60 dB").holds);
  EXPECT_FALSE(judged("what: silence" + kPluck + "after: 0.5 s, most: -60 dB").holds);
  EXPECT_TRUE(judged("what: energy, most: 1e-9").holds);
  EXPECT_NEAR(judged("what: glide" + kPluck +
                     "near: A3, times: [0.1, 1], expect: 0.1 cents, "
                     "within: 1 cent")
                  .measured.at(0),
              1.0, 1e-3);
}

TEST(TruthsTest, SayWhyTheyCannotBeMeasured) {
  EXPECT_THAT(judged("what: pitch, of: out, expect: A3, within: 1 cent").trouble,
              HasSubstr("no sound"));
  EXPECT_THAT(judged("what: t60" + kPluck + "near: A3, least: 0.1, seconds: 0.4").trouble,
              HasSubstr("does not decay by 25 dB"));
  EXPECT_FALSE(judged("what: energy, play: {gesture: ../x.csv}, most: 1").trouble.empty());
}

/// As they are shipped; those of the larger instruments are in shipped_truths_long_test.cpp.
TEST(TruthsToolTest, OfModelsAndTheLibraryHold) {
  for (const char* name : {"lib_truths", "string", "harmonics", "violin_g", "glass12"}) {
    const std::string file = std::string("models/") + name + ".yaml";
    const test::Outcome outcome = test::run("check", test::repository(file) + " --truths");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
  }
}

TEST(TruthsToolTest, ThatDoNotHoldEndWithOne) {
  const test::ScratchFile scene(kScene + "  - {what: energy, most: 1e-30}\n");
  const test::Outcome outcome = test::run("check", scene.path() + " --truths");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.text, HasSubstr("DOES NOT HOLD: " + scene.path() + ":16:5: energy"));
  const test::ScratchFile none("ergotic: 1\nsections: {a: {}}\nmats: {m: {type: mass, mass: 1}}\n");
  EXPECT_EQ(test::run("check", none.path() + " --truths").code, 1);
}

}  // namespace
}  // namespace ergotic::tools
