// SPDX-License-Identifier: BSD-3-Clause
#include "support/scratch_file.hpp"
#include "support/tool_process.hpp"

namespace ergotic {
namespace {

using test::run;
using test::ScratchFile;

const char kBrief[] = R"(ergotic: 1
let: {masses: [1 g, 2 g, 3 g]}
sections: {a: {rate: audio}}
defaults: {spring_damper: {stiffness: 2 kN/m, damping: 1e-3}}
mats:
  g: {type: ground, section: a}
  'm_{i}': {for: {i: 0..2}, type: mass, section: a, mass: '=masses[i]', v: 1}
lias:
  's_{i}': {for: {i: 0..2}, type: spring_damper, between: [g, 'm_{i}']}
outputs:
  'o_{i}': {for: {i: 0..2}, at: 'm_{i}', quantity: velocity, channel: '=i + 1'}
)";

class ExpandTest : public ::testing::Test {
 protected:
  static std::string soundOf(const ScratchFile& scene) {
    const ScratchFile wav;
    const test::Outcome played =
        run("render", scene.path() + " --seconds 0.05 --out " + wav.path());
    EXPECT_EQ(played.code, 0) << played.text;
    return wav.text();
  }
};

TEST_F(ExpandTest, WritesWhatIsPlayed) {
  const ScratchFile brief(kBrief);
  const test::Outcome plain = run("expand", brief.path());
  ASSERT_EQ(plain.code, 0) << plain.text;
  EXPECT_THAT(plain.text, HasSubstr("m_2: {type: mass, section: a, mass: 0.003"));
  EXPECT_THAT(plain.text, HasSubstr("stiffness: 2 kN/m"));
  EXPECT_THAT(plain.text, Not(HasSubstr("for:")));

  const ScratchFile written(plain.text);
  EXPECT_EQ(run("expand", written.path()).text, plain.text) << "what is plain stays as it is";
  EXPECT_GT(soundOf(brief).size(), 1000U);
  EXPECT_EQ(soundOf(brief), soundOf(written));
}

TEST_F(ExpandTest, CheckExplainsWhereAPartComesFrom) {
  const ScratchFile scene(R"(ergotic: 1
sections: {a: {rate: audio}}
define:
  pair:
    needs: {s: audio}
    generators:
      - {type: string, name: body, section: s, masses: 4, mass: 1 g, frequency: 300,
         to: [0.3, 0]}
    mats: {m: {type: mass, section: s, mass: 5 g}}
use:
  - {for: {i: 0..1}, is: pair, as: 'p_{i}', in: {s: a}}
)");
  const test::Outcome mass = run("check", scene.path() + " --explain p_1.m");
  EXPECT_EQ(mass.code, 0);
  EXPECT_THAT(mass.text, StartsWith(scene.path() + ":9:"));
  EXPECT_THAT(mass.text, HasSubstr("in p_1 (pair), used at " + scene.path() + ":11:"));
  EXPECT_THAT(mass.text, HasSubstr("p_1.m: {type: mass, section: a, mass: 5 g}"));
  EXPECT_THAT(run("check", scene.path() + " --explain p_0.body.2").text,
              HasSubstr("type: string, name: p_0.body"));
  const test::Outcome unknown = run("check", scene.path() + " --explain p_1.k");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.text, HasSubstr("nothing is called 'p_1.k'"));
}

TEST_F(ExpandTest, SaysWhereWhatIsWrongStands) {
  const ScratchFile broken("ergotic: 1\nlet: {a: =1/0}\n");
  const test::Outcome refused = run("expand", broken.path());
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.text, HasSubstr(broken.path() + ":2:"));
}

}  // namespace
}  // namespace ergotic
