// SPDX-License-Identifier: BSD-3-Clause

#include "ergotic/tgr/safety/force_limit.hpp"

#include "ergotic/tgr/safety/safety_config.hpp"
#include "ergotic/tgr/safety/slew_limit.hpp"
#include "ergotic/tgr/safety_chain.hpp"
#include "support/test.hpp"

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

TEST(SafetyConfigTest, RefusesSettingsOutsideTheirRange) {
  const auto refuses = [](auto change) {
    SafetyConfig config;
    change(config);
    EXPECT_THROW(SafetyChain(config, 12, 1e-3), Exception);
  };
  refuses([](SafetyConfig& c) { c.force_limit_n = kAbsoluteForceLimitN + 0.1; });
  refuses([](SafetyConfig& c) { c.force_limit_n = -1.0; });
  refuses([](SafetyConfig& c) { c.force_limit_n = std::numeric_limits<double>::quiet_NaN(); });
  refuses([](SafetyConfig& c) { c.ramp_s = 0.0; });
  refuses([](SafetyConfig& c) { c.ramp_s = 11.0; });
  refuses([](SafetyConfig& c) { c.resume_ramp_s = 0.0; });
  refuses([](SafetyConfig& c) { c.position_limit_m = 0.0; });
  refuses([](SafetyConfig& c) { c.max_missing = -1; });
  refuses([](SafetyConfig& c) { c.slew_n_per_s = 9.0; });
  refuses([](SafetyConfig& c) { c.slew_n_per_s = std::numeric_limits<double>::infinity(); });
  refuses([](SafetyConfig& c) { c.raw_force_limit_n = 0.5; });
  refuses([](SafetyConfig& c) { c.max_speed_m_per_s = 0.0; });
  refuses([](SafetyConfig& c) { c.frozen_s = -1.0; });
  refuses([](SafetyConfig& c) { c.frozen_s = 11.0; });
  refuses([](SafetyConfig& c) { c.energy_limit_j = 0.0; });
  refuses([](SafetyConfig& c) { c.energy_cap_j = 11.0; });
  refuses([](SafetyConfig& c) { c.energy_supply_w = -0.1; });
  refuses([](SafetyConfig& c) { c.slice_damping = 101.0; });
  refuses([](SafetyConfig& c) { c.slice_mass_kg = 0.0; });
  EXPECT_THROW(SafetyChain(SafetyConfig{}, 0, 1e-3), Exception);
  EXPECT_THROW(SafetyChain(SafetyConfig{}, kMaxSlices + 1, 1e-3), Exception);
  EXPECT_THROW(SafetyChain(SafetyConfig{}, 12, 1e-3, -1), Exception);
  EXPECT_THROW(SafetyChain(SafetyConfig{}, 12, 1e-3, 256), Exception);
}

}  // namespace
}  // namespace ergotic::tgr
