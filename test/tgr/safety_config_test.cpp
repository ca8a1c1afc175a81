// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/safety_config.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/safety_chain.hpp"

namespace ergotic::tgr {
namespace {

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
