// SPDX-License-Identifier: BSD-3-Clause
#include "tools/proofs.hpp"

namespace ergotic {
namespace {

/// Only what is not linear and is joined to it raises a section.
TEST(ProofTest, HoldsNoSectionFasterThanSettlingMakesIt) {
  const std::string plain =
      "ergotic: 1\nsections: {fast: {}, slow: {rate: gestural}}\nmats:\n"
      "  g: {type: ground, section: fast}\n  f: {type: mass, section: fast, mass: 1}\n"
      "  m: {type: mass, section: slow, mass: 1}\n  n: {type: mass, section: fast, mass: "
      "1}\nlias:\n"
      "  own: {type: spring, between: [f, g], stiffness: 1e4}\n"
      "  joins: {type: spring, between: [m, f], stiffness: 1e4}\n"
      "  hit: {type: contact, between: [n, g], stiffness: 1e4}\n";
  const auto with = [&](const std::string& said, const std::string& instead) {
    std::string text = plain;
    return text.replace(text.find(said), said.size(), instead);
  };
  const std::string fast = with("slow: {rate: gestural}", "slow: {}");
  EXPECT_EQ(refusalUnderTheNameOf(plain, plain), "");
  EXPECT_THAT(refusalUnderTheNameOf(plain, fast), HasSubstr("slow: divisor is not 1"));
  const std::string joined = with("[n, g]", "[f, n]");
  EXPECT_EQ(refusalUnderTheNameOf(joined, joined), "");
  // What is guarded by its text joins nothing.
  const std::string apart =
      "ergotic: 1\nsections: {fast: {}, slow: {rate: gestural}}\nmats:\n"
      "  f: {type: mass, section: fast, mass: 1}\n  m: {type: mass, section: slow, mass: 1}\n"
      "  g: {type: ground, section: slow}\nlias:\n"
      "  hit: {type: contact, between: [m, f], stiffness: 1e4, scheme: guarded}\n"
      "  open: {type: contact, between: [m, g], stiffness: 1e4}\n";
  std::string raised = apart;
  raised.replace(raised.find("slow: {rate: gestural}"), 22, "slow: {}");
  EXPECT_THAT(refusalUnderTheNameOf(apart, raised), HasSubstr("slow: divisor is not 1"));
}

/// A chaplet keeps the rate of what it hangs on, whatever is not linear behind it; what looks like
/// one but hangs on nothing slower does not.
TEST(ProofTest, HoldsNoSectionRaisedThatAChapletKeeps) {
  const auto sceneOf = [](const std::string& rate, const std::string& from) {
    return "ergotic: 1\ngestural_rate: 3150\nsections: {fast: {}, slow: {" + rate +
           "}}\nmats:\n  g: {type: ground, section: fast}\n"
           "  m: {type: mass, section: slow, mass: 1}\n"
           "  f: {type: mass, section: fast, mass: 0.01}\n"
           "generators:\n  - {type: chaplet, name: c, section: fast, from: " +
           from +
           ", mass: 0.005}\nlias:\n  own: {type: spring, between: [f, g], stiffness: 1e4}\n"
           "  joins: {type: spring, between: [m, f], stiffness: 100}\n"
           "  hit: {type: contact, between: [c.1, f], stiffness: 1e4}\n";
  };
  const std::string slow = "rate: gestural";
  EXPECT_THAT(refusalUnderTheNameOf(sceneOf(slow, "m"), sceneOf("", "m")),
              HasSubstr("slow: divisor is not 1"));
  EXPECT_EQ(refusalUnderTheNameOf(sceneOf(slow, "f"), sceneOf(slow, "f")), "");
}

}  // namespace
}  // namespace ergotic
