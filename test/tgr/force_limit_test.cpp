// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/force_limit.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "ergotic/tgr/safety/slew_limit.hpp"

namespace ergotic::tgr {
namespace {

TEST(ForceLimitTest, PassesWhatIsWithinAndCutsTheRest) {
  const ForceLimit limit(20.0);
  for (const double force : {-20.0, -1e-300, 0.0, 3.25, 20.0}) {
    EXPECT_EQ(limit.limited(force), force);
  }
  EXPECT_EQ(limit.limited(20.1), 20.0);
  EXPECT_EQ(limit.limited(-std::numeric_limits<double>::infinity()), -20.0);
  EXPECT_EQ(limit.limited(std::numeric_limits<double>::quiet_NaN()), 0.0);
}

TEST(ForceLimitTest, NeverExceedsWhatIsCompiledIn) {
  EXPECT_EQ(ForceLimit(1e9).limited(1e12), kAbsoluteForceLimitN);
  EXPECT_EQ(ForceLimit(-5.0).limited(1.0), 0.0);
}

TEST(SlewLimitTest, LetsForceGrowByAStepPerTick) {
  const SlewLimit slew(0.5);
  double force = 0.0;
  for (int n = 1; n <= 10; ++n) {
    force = slew.limited(5.0, force);
    EXPECT_EQ(force, 0.5 * n);
  }
  EXPECT_EQ(slew.limited(5.0, force), 5.0);
  EXPECT_EQ(slew.limited(-9.0, -1.0), -1.5);
}

TEST(SlewLimitTest, LetsForceFallAtOnce) {
  const SlewLimit slew(0.5);
  EXPECT_EQ(slew.limited(0.0, 20.0), 0.0);
  EXPECT_EQ(slew.limited(3.0, 20.0), 3.0);
  EXPECT_EQ(slew.limited(-0.1, -20.0), -0.1);
}

TEST(SlewLimitTest, StartsFromZeroOnTheOtherSide) {
  const SlewLimit slew(0.5);
  EXPECT_EQ(slew.limited(-20.0, 20.0), -0.5);
  EXPECT_EQ(slew.limited(20.0, -20.0), 0.5);
  EXPECT_EQ(slew.limited(0.25, -20.0), 0.25);
}

TEST(SlewLimitTest, TakesHugeForces) {
  const SlewLimit slew(0.5);
  EXPECT_EQ(slew.limited(1e308, 1e10), 1e10 + 0.5);
  EXPECT_EQ(slew.limited(-1e308, 1e10), -0.5);
}

}  // namespace
}  // namespace ergotic::tgr
