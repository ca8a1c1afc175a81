// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

Scene withFelt(const std::string& numbers) {
  return readYaml(
      "ergotic: 1\nname: s\nparameters:\n  c: {value: 1, range: [0, 2]}\n"
      "sections:\n  s: {rate: audio}\n"
      "mats:\n  m: {type: mass, section: s, mass: 1}\n  g: {type: ground, section: s}\n"
      "lias:\n  l: {type: felt, between: [m, g], " +
          numbers + "}\n",
      "s.yaml");
}

TEST(FeltTest, IsReadFieldByField) {
  const Lia lia =
      withFelt("stiffness: 1e8, exponent: 2.5, damping: 0.5*$c, threshold: -0.01").lias[0];
  EXPECT_EQ(lia.type, LiaType::kFelt);
  EXPECT_EQ(lia.scheme, Scheme::kAuto);
  EXPECT_EQ(lia.stiffness.factor, 1e8);
  EXPECT_EQ(lia.law->exponent.factor, 2.5);
  EXPECT_EQ(lia.damping.factor, 0.5);
  EXPECT_EQ(lia.damping.parameter, 0);
  EXPECT_EQ(lia.law->width.factor, -0.01);
}

TEST(FeltTest, NumbersOutOfRangeAreRefused) {
  const std::pair<const char*, const char*> faults[] = {
      {"stiffness: -1, exponent: 2, damping: 1",
       "'stiffness' of link 'l' = -1 N/m^exponent is out of range, allowed: >= 0 N/m^exponent"},
      {"stiffness: 1, exponent: 0.9, damping: 1", "= 0.9 is out of range, allowed: 1...5"},
      {"stiffness: 1, exponent: 5.1, damping: 1", "= 5.1 is out of range, allowed: 1...5"},
      {"stiffness: 1, exponent: 2, damping: -1",
       "'damping' of link 'l' = -1 s/m is out of range, allowed: >= 0 s/m"},
      {"stiffness: 1, exponent: 2", "missing key 'damping'"},
      {"stiffness: 1, exponent: 2, damping: 1, rest_length: 1", "'rest_length'"},
  };
  for (const auto& fault : faults) {
    EXPECT_THAT(complaintOf<TextError>([&] { withFelt(fault.first); }), HasSubstr(fault.second));
  }
}

}  // namespace
}  // namespace ergotic::scene
