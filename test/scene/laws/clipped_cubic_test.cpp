// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/clipped_cubic.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"

namespace ergotic::scene {
namespace {

Lia clipped(LiaType type, double k, double q, double limit, ClippedLaw law) {
  Lia lia;
  lia.type = type;
  lia.stiffness = {k};
  lia.law.edit().nonlinearity = {q};
  lia.law.edit().stiffness_limit = {limit};
  completeClippedLaw(lia, law);
  return lia;
}

TEST(ClippedLawTest, IsContinuousAtItsTippingPointInYaml) {
  const Lia lia = clipped(LiaType::kClippedCubic, 2.0, 5.0, 22.0, ClippedLaw::kContinuous);
  const double e = lia.law->tipping_point;
  EXPECT_DOUBLE_EQ(e, 2.0);
  EXPECT_DOUBLE_EQ(2.0 * e + 5.0 * e * e * e, 22.0 * e);
  EXPECT_EQ(lia.law->limit_damping.factor, 0.0);
}

TEST(ClippedLawTest, TipsWhereMdlSaysAndIsMoreDampedThere) {
  const Lia lia = clipped(LiaType::kCubicContact, 0.01, 0.4, 0.05, ClippedLaw::kMdl);
  EXPECT_DOUBLE_EQ(lia.law->tipping_point, 0.5);
  EXPECT_DOUBLE_EQ(lia.law->limit_damping.factor, 0.015);
  EXPECT_EQ(lia.type, LiaType::kCubicContact);
}

TEST(ClippedLawTest, IsStraightWithoutACube) {
  const Lia lia = clipped(LiaType::kClippedCubic, 0.01, 0.0, 0.05, ClippedLaw::kMdl);
  EXPECT_EQ(lia.type, LiaType::kSpringDamper);
  EXPECT_EQ(lia.stiffness.factor, 0.01);
}

TEST(ClippedLawTest, IsStraightWithTheLimitWhenStifferThanThat) {
  const Lia lia = clipped(LiaType::kCubicContact, 0.06, 0.4, 0.05, ClippedLaw::kMdl);
  EXPECT_EQ(lia.type, LiaType::kContact);
  EXPECT_EQ(lia.stiffness.factor, 0.05);
  EXPECT_EQ(lia.law->limit_damping.factor, 0.0);
}

TEST(ClippedLawTest, IsNotAParametersBusiness) {
  const std::string text =
      "ergotic: 1\nname: s\nparameters:\n  p: {value: 1, range: [1, 2]}\n"
      "sections:\n  s: {rate: audio}\n"
      "mats:\n  m: {type: mass, section: s, mass: 1}\n  g: {type: ground, section: s}\n"
      "lias:\n  l: {type: clipped_cubic, between: [m, g], stiffness: $p, nonlinearity: 2,\n"
      "      stiffness_limit: 9}\n";
  try {
    readYaml(text, "s.yaml");
    FAIL() << "read";
  } catch (const TextError& error) {
    EXPECT_EQ(error.line(), 11);
    EXPECT_NE(std::string(error.what()).find("'stiffness'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ergotic::scene
