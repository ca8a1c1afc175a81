// SPDX-License-Identifier: BSD-3-Clause
// Proofs of scenes whose text is brief: a proof is of what that is written out as.
#include "support/tool_process.hpp"
#include "tools/proofs.hpp"

namespace ergotic {
namespace {

TEST(BriefProofTest, IsOfWhatTheSceneIsWrittenOutAs) {
  const ScratchFile proof;
  const ScratchFile said;
  const ScratchFile written;
  const std::string model = repository("models/drum.yaml");
  EXPECT_EQ(test::run("check", model + " --proof " + proof.path()).code, 0);
  const std::string check = "scripts/check_proof " + proof.path() + " ";
  EXPECT_EQ(python(check + model + " 2> " + said.path()), 1);
  EXPECT_THAT(said.text(), HasSubstr("in brief: prove the one that `expand`"));
  writtenOut(model, written.path());
  EXPECT_EQ(test::run("check", written.path() + " --proof " + proof.path()).code, 0);
  EXPECT_EQ(python(check + written.path()), 0);
}

std::string oneSpring(const std::string& mass,
                      const std::string& stiffness,
                      const std::string& damping) {
  return "ergotic: 1\nsections: {a: {rate: audio}}\nmats: {m: {type: mass, mass: " + mass +
         "}, g: {type: ground}}\nlias: {k: {type: spring_damper, between: [g, m], stiffness: " +
         stiffness + ", damping: " + damping + "}}\n";
}

// The script reads them by itself.
TEST(BriefProofTest, HoldsTheNumbersOfUnits) {
  const std::string bare = oneSpring("1e-3", "1.5", "0.02");
  for (const std::string& units :
       {oneSpring("1 g", "1.5e-3 N/mm", "20 mN s/m"), oneSpring("1e3 mg", "1.5 kg/s^2", "2 cN s/m"),
        oneSpring("1e-3 kg", "150 N cm/m^2", "0.02 N*s/m")}) {
    EXPECT_EQ(refusalUnderTheNameOf(units, bare), "") << units;
    EXPECT_EQ(refusalUnderTheNameOf(bare, units), "") << units;
  }
  for (const std::string& other :
       {oneSpring("1 mg", "1.5", "0.02"), oneSpring("1 g", "1.5 kN/m", "0.02"),
        oneSpring("1 g", "1.5", "3 mN s/m")}) {
    EXPECT_THAT(refusalUnderTheNameOf(other, bare), Not(testing::IsEmpty())) << other;
  }
}

}  // namespace
}  // namespace ergotic
