// SPDX-License-Identifier: BSD-3-Clause
#include "scene/clipped_law.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace ergotic::scene {
namespace {

Lia clipped(LiaType type, double k, double q, double limit) {
  Lia lia;
  lia.type = type;
  lia.stiffness = {k};
  lia.nonlinearity = {q};
  lia.stiffness_limit = {limit};
  lia.damping = {0.5};
  return lia;
}

TEST(ClippedLawTest, ContinuousLawTipsWhereCubeAndLimitMeet) {
  Lia lia = clipped(LiaType::kClippedCubic, 1.0, 4.0, 10.0);
  completeClippedLaw(lia, ClippedLaw::kContinuous);
  const double e = lia.tipping_point;
  EXPECT_NEAR(1.0 * e + 4.0 * e * e * e, 10.0 * e, 1e-12);
  EXPECT_GT(e, 0.0);
  EXPECT_EQ(lia.limit_damping.factor, 0.0);
}

TEST(ClippedLawTest, MdlLawTipsAtItsOwnPointAndDampsMoreBeyond) {
  Lia lia = clipped(LiaType::kCubicContact, 1.0, 4.0, 10.0);
  completeClippedLaw(lia, ClippedLaw::kMdl);
  EXPECT_DOUBLE_EQ(lia.tipping_point, 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(lia.limit_damping.factor, 3.0);
  EXPECT_EQ(lia.type, LiaType::kCubicContact);
}

TEST(ClippedLawTest, WithoutACubeTheLimitIsNeverReached) {
  for (const ClippedLaw law : {ClippedLaw::kMdl, ClippedLaw::kContinuous}) {
    Lia spring = clipped(LiaType::kClippedCubic, 1.0, 0.0, 10.0);
    completeClippedLaw(spring, law);
    EXPECT_EQ(spring.type, LiaType::kSpringDamper);
    EXPECT_EQ(spring.stiffness.factor, 1.0);
    EXPECT_EQ(spring.damping.factor, 0.5);
  }
}

TEST(ClippedLawTest, BeyondTheLimitFromTheStartIsAStraightLinkOfTheLimit) {
  Lia contact = clipped(LiaType::kCubicContact, 20.0, 4.0, 10.0);
  completeClippedLaw(contact, ClippedLaw::kMdl);
  EXPECT_EQ(contact.type, LiaType::kContact);
  EXPECT_EQ(contact.stiffness.factor, 10.0);
  EXPECT_EQ(contact.nonlinearity.factor, 0.0);
}

TEST(ClippedLawTest, OtherLinksAreLeftAlone) {
  Lia lia = clipped(LiaType::kCubic, 1.0, 4.0, 10.0);
  completeClippedLaw(lia, ClippedLaw::kMdl);
  EXPECT_EQ(lia.type, LiaType::kCubic);
  EXPECT_EQ(lia.limit_damping.factor, 0.0);
}

}  // namespace
}  // namespace ergotic::scene
