// SPDX-License-Identifier: BSD-3-Clause
// Proofs of what bends and of what remembers.
#include "ergotic/exception.hpp"
#include "tools/proofs.hpp"

namespace ergotic {
namespace {

std::string withInstead(std::string text, const std::string& said, const std::string& instead) {
  return text.replace(text.find(said), said.size(), instead);
}

/// A free bar, which no factor of its stiffness could prove to be definite.
const std::string kBar =
    "ergotic: 1\nparameters: {k: {value: 1, range: [0.5, 2]}}\nsections: {s: {}}\nmats:\n"
    "  a: {type: mass, mass: 1}\n  b: {type: mass, mass: 1}\n  c: {type: mass, mass: 1}\n"
    "  d: {type: mass, mass: 1}\n  g: {type: ground}\nlias:\n"
    "  l: {type: bend, between: [a, b, c], weights: [1, -2, 1], stiffness: 1e8*$k}\n"
    "  m: {type: bend, between: [b, c, d], weights: [1, -2, 1], stiffness: 1e8*$k, damping: 9}\n"
    "  hit: {type: contact, between: [g, a], stiffness: 1e4}\n";

TEST(ProofTest, SeesABendAsOneLoadAndKnowsItsNumbers) {
  EXPECT_EQ(refusalUnderTheNameOf(kBar, kBar), "");
  for (const auto& [said, instead, reason] :
       {std::tuple("[1, -2, 1], stiffness: 1e8*$k}", "[1, -3, 2], stiffness: 1e8*$k}",
                   "l: weights is"),
        std::tuple("[b, c, d]", "[b, d, c]", "m: between is"),
        std::tuple("damping: 9", "damping: 0", "m: damping is"),
        std::tuple("[1, -2, 1], stiffness: 1e8*$k}", "[1, -2, 1], stiffness: 1e7*$k}",
                   "l: stiffness is")}) {
    EXPECT_THAT(refusalUnderTheNameOf(kBar, withInstead(kBar, said, instead)), HasSubstr(reason));
  }
}

const std::string kFelt =
    "ergotic: 1\nparameters: {k: {value: 1, range: [0.5, 2]}}\nsections: {s: {}}\nmats:\n"
    "  m: {type: mass, mass: 1}\n  g: {type: ground}\nlias:\n"
    "  l: {type: relaxing, between: [m, g], stiffness: 1e8*$k, material: felt}\n"
    "  n: {type: relaxing, between: [m, g], stiffness: 1e8, branches: [[1e7*$k, 1e-3]]}\n"
    "  o: {type: relaxing, between: [m, g], stiffness: 1e8, loss_factor: 0.02, damping: 3}\n";

TEST(ProofTest, CountsWhatIsRememberedAndKnowsItsNumbers) {
  EXPECT_EQ(refusalUnderTheNameOf(kFelt, kFelt), "");
  for (const auto& [said, instead, reason] :
       {std::tuple("felt", "nylon", "l: branches is"), std::tuple("1e-3", "2e-3", "n: branches is"),
        std::tuple("[[1e7*$k", "[[1e6*$k", "n: branches is"),
        std::tuple("0.02", "0.01", "o: branches is")}) {
    EXPECT_THAT(refusalUnderTheNameOf(kFelt, withInstead(kFelt, said, instead)), HasSubstr(reason));
  }
}

const std::string kStretch =
    "ergotic: 1\nsections: {s: {}}\nmats:\n  m: {type: mass, mass: 1}\n  g: {type: ground}\nlias:\n"
    "  k: {type: spring, between: [m, g], stiffness: 1e6}\n"
    "  t: {type: stretch, of: [k], spacing: 1, hardening: 1}\n";

TEST(ProofTest, IsNotWrittenOfATankForWhichItHasNoRule) {
  try {
    refusalUnderTheNameOf(kStretch, kStretch);
    ADD_FAILURE() << "a proof was written";
  } catch (const Exception& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("not written: link 't' is one tank of many links"));
  }
}

}  // namespace
}  // namespace ergotic
