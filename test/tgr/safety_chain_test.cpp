// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety_chain.hpp"

#include "constants.hpp"
#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

using test::kNan;

constexpr double kExactTick = 1.0 / 1024.0;  // a power of two: ramps add up exactly

SafetyConfig quickConfig() {
  SafetyConfig config;
  config.ramp_s = 0.125;           // 128 ticks
  config.resume_ramp_s = 0.03125;  // 32 ticks
  config.max_missing = 3;
  config.slew_n_per_s = 1e6;
  return config;
}

class SafetyChainTest : public ::testing::Test {
 protected:
  double limited(double force) {
    std::array<double, 2> forces{force, 0.0};
    chain_.limit(forces.data());
    return forces[0];
  }
  std::uint64_t validated(double x0, double x1, std::uint32_t flags = kExchangeOk) {
    positions_ = {x0, x1};
    return chain_.validate(positions_.data(), flags, 0);
  }
  void openFully() {
    chain_.engage();
    for (int i = 0; i < 128; ++i) {
      limited(0.0);
    }
  }

  SafetyChain chain_{quickConfig(), 2, kExactTick};
  std::array<double, 2> positions_{};
};

TEST_F(SafetyChainTest, RampsLinearlyFromZeroToOne) {
  chain_.engage();
  for (int n = 0; n <= 128; ++n) {
    ASSERT_EQ(limited(8.0), 8.0 * n / 128.0);
  }
  EXPECT_EQ(limited(8.0), 8.0);
  EXPECT_EQ(chain_.gain(), 1.0);
}

TEST_F(SafetyChainTest, ClipsAfterTheGain) {
  chain_.engage();
  for (int n = 0; n < 64; ++n) {
    limited(0.0);
  }
  EXPECT_EQ(limited(30.0), 15.0);  // half of it: clipping first would give 10
  EXPECT_EQ(limited(30.0), 15.0 + 30.0 / 128.0);
  limited(0.0);
  EXPECT_EQ(limited(-400.0), -20.0);
}

TEST_F(SafetyChainTest, GivesExactZerosWhileClosed) {
  EXPECT_EQ(limited(-5.0), 0.0);
  EXPECT_FALSE(std::signbit(limited(-5.0)));
  openFully();
  EXPECT_EQ(limited(5.0), 5.0);
  chain_.disengage();
  EXPECT_EQ(limited(5.0), 0.0);
}

TEST_F(SafetyChainTest, StartsFromZeroAtEveryEngage) {
  openFully();
  chain_.disengage();
  chain_.engage();
  EXPECT_EQ(limited(8.0), 0.0);
  EXPECT_EQ(limited(8.0), 8.0 / 128.0);
}

TEST_F(SafetyChainTest, KeepsItsGainWhenEngagedTwice) {
  openFully();
  chain_.engage();
  EXPECT_EQ(limited(8.0), 8.0);
}

TEST_F(SafetyChainTest, ResumesFromZeroByItsOwnShorterRamp) {
  openFully();
  chain_.resume();
  for (int n = 0; n <= 32; ++n) {
    ASSERT_EQ(limited(8.0), 8.0 * n / 32.0);
  }
  EXPECT_EQ(limited(8.0), 8.0);
}

TEST_F(SafetyChainTest, ResumingNeitherOpensTheGateNorShortensTheRamp) {
  chain_.resume();
  EXPECT_FALSE(chain_.isOpen());
  EXPECT_EQ(limited(8.0), 0.0);
  chain_.engage();
  for (int n = 0; n < 64; ++n) {
    limited(0.0);
  }
  chain_.resume();
  EXPECT_EQ(limited(8.0), 0.0);
  EXPECT_EQ(limited(8.0), 8.0 * (65.0 / 128.0) / 32.0);
}

TEST_F(SafetyChainTest, SilencesAllSlicesInTheTickOfANonFiniteForce) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    openFully();
    std::array<double, 2> forces{5.0, bad};
    chain_.limit(forces.data());
    EXPECT_EQ(forces, (std::array<double, 2>{0.0, 0.0}));
    EXPECT_EQ(chain_.fault(), FaultReason::kModelBlowUp);
    EXPECT_EQ(chain_.faultSlice(), 1);
    EXPECT_FALSE(chain_.isOpen());
    EXPECT_EQ(limited(5.0), 0.0) << "the gate must latch";
  }
}

TEST_F(SafetyChainTest, LeavesGoodPositionsAlone) {
  EXPECT_EQ(validated(0.0999, -0.0999), 0U);
  EXPECT_EQ(positions_, (std::array<double, 2>{0.0999, -0.0999}));
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
}

TEST_F(SafetyChainTest, HoldsABadPositionAndFaultsAtOnce) {
  for (const double bad : {kNan, kInfinity, 0.1, -0.1000001}) {
    openFully();
    validated(0.01, 0.02);
    EXPECT_EQ(validated(0.012, bad), 0b10U);
    EXPECT_EQ(positions_, (std::array<double, 2>{0.012, 0.02}));
    EXPECT_EQ(chain_.fault(), FaultReason::kBadPosition);
    EXPECT_EQ(chain_.faultSlice(), 1);
    EXPECT_EQ(limited(5.0), 0.0);
  }
}

TEST_F(SafetyChainTest, HoldsMissingSamplesAndFaultsAfterTooManyInARow) {
  openFully();
  validated(0.01, 0.02);
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(validated(0.05, 0.05, kMissingSample), 0b11U);
    EXPECT_EQ(positions_, (std::array<double, 2>{0.01, 0.02}));
    EXPECT_EQ(chain_.fault(), FaultReason::kNone);
  }
  EXPECT_EQ(validated(0.05, 0.05, kMissingSample), 0b11U);
  EXPECT_EQ(chain_.fault(), FaultReason::kMissingSamples);
  EXPECT_FALSE(chain_.isOpen());
}

TEST_F(SafetyChainTest, CountsMissingSamplesInARowOnly) {
  for (int n = 0; n < 20; ++n) {
    validated(0.0, 0.0, n % 4 == 3 ? kExchangeOk : kMissingSample);
  }
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
}

TEST_F(SafetyChainTest, FaultsAgainAfterRecoveryWhileSamplesAreStillMissing) {
  const auto miss = [this] {
    for (int n = 0; n < 4; ++n) {
      validated(0.0, 0.0, kMissingSample);
    }
  };
  miss();
  chain_.engage();
  EXPECT_FALSE(chain_.isOpen()) << "a fault stays until recovery";
  chain_.recover();
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
  miss();
  EXPECT_EQ(chain_.fault(), FaultReason::kMissingSamples);
}

TEST_F(SafetyChainTest, FaultsAtOnceWhenTheDeviceIsLost) {
  openFully();
  validated(0.01, 0.02);
  EXPECT_EQ(validated(kNan, kNan, kDeviceLost | kMissingSample), 0b11U);
  EXPECT_EQ(positions_, (std::array<double, 2>{0.01, 0.02}));
  EXPECT_EQ(chain_.fault(), FaultReason::kDeviceLost);
  EXPECT_EQ(limited(5.0), 0.0);
}

TEST_F(SafetyChainTest, TellsTheFirstFaultUntilRecovery) {
  validated(kNan, 0.0);
  validated(0.0, 0.0, kDeviceLost);
  EXPECT_EQ(chain_.fault(), FaultReason::kBadPosition);
  chain_.recover();
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
  EXPECT_EQ(chain_.faultSlice(), -1);
}

TEST_F(SafetyChainTest, NamesEverySliceOfAFullBank) {
  SafetyChain chain(quickConfig(), kMaxSlices, kExactTick);
  std::array<double, kMaxSlices> positions{};
  EXPECT_EQ(chain.validate(positions.data(), kMissingSample, 0), ~std::uint64_t{0});
  positions.fill(1.0);
  EXPECT_EQ(chain.validate(positions.data(), kExchangeOk, 0), ~std::uint64_t{0});
}

TEST_F(SafetyChainTest, FaultsAtOnceWhenAForceWasNotTaken) {
  openFully();
  EXPECT_EQ(validated(0.01, 0.02, kWriteFailed), 0U) << "the positions are good";
  EXPECT_EQ(chain_.fault(), FaultReason::kWriteFailed);
  EXPECT_EQ(limited(5.0), 0.0);
}

TEST_F(SafetyChainTest, DoesNotCountTicksThatTheHostMissed) {
  validated(0.0, 0.0);
  std::array<double, 2> positions{};
  for (int n = 0; n < 3; ++n) {
    chain_.validate(positions.data(), kMissingSample, 1000);
  }
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
}

TEST_F(SafetyChainTest, HoldsAJumpAndFaultsUnlessTheHostMissedTheTicksBetween) {
  validated(0.01, 0.02);
  std::array<double, 2> far{0.02, 0.02};
  EXPECT_EQ(chain_.validate(far.data(), kExchangeOk, 2), 0U);
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
  EXPECT_EQ(validated(0.03, 0.02), 0b01U);
  EXPECT_EQ(positions_, (std::array<double, 2>{0.02, 0.02}));
  EXPECT_EQ(chain_.fault(), FaultReason::kJump);
  EXPECT_EQ(chain_.faultSlice(), 0);
}

TEST_F(SafetyChainTest, AllowsMoreWayAfterSamplesThatDidNotCome) {
  const double step = SafetyConfig{}.max_speed_m_per_s * kExactTick;
  validated(0.0, 0.0);
  validated(0.09, 0.09, kMissingSample);
  validated(0.09, 0.09, kMissingSample);
  EXPECT_EQ(validated(2.9 * step, -2.9 * step), 0U);
  EXPECT_EQ(validated(0.0, -2.9 * step), 0b01U) << "time is used up";
  EXPECT_EQ(chain_.fault(), FaultReason::kJump);
}

TEST_F(SafetyChainTest, FaultsWhenASensorIsFrozenIfAskedTo) {
  SafetyConfig config = quickConfig();
  config.frozen_s = 10.0 * kExactTick;
  SafetyChain chain(config, 1, kExactTick);
  double x = 0.01;
  for (int n = 0; n < 20; ++n) {  // ten samples, and as many that do not count as they did not come
    chain.validate(&x, n % 2 == 0 ? kExchangeOk : kMissingSample, 0);
    EXPECT_EQ(chain.fault(), FaultReason::kNone);
  }
  EXPECT_EQ(chain.validate(&x, kExchangeOk, 0), 0U);
  EXPECT_EQ(chain.fault(), FaultReason::kFrozen);
}

TEST_F(SafetyChainTest, MindsNeitherPositionsNorForcesOfSlicesOutOfUse) {
  chain_.setInUse(0b01U);
  openFully();
  EXPECT_EQ(validated(0.0, kNan), 0b10U) << "held all the same";
  EXPECT_EQ(validated(0.0, 0.09), 0U);
  EXPECT_EQ(validated(0.0, -0.09), 0b10U);
  std::array<double, 2> forces{5.0, kNan};
  chain_.limit(forces.data());
  EXPECT_EQ(forces, (std::array<double, 2>{5.0, 0.0}));
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
}

TEST_F(SafetyChainTest, MeetsASliceAfreshThatComesIntoUse) {
  chain_.setInUse(0b01U);
  validated(0.0, -0.09);
  chain_.setInUse(0b11U);
  EXPECT_EQ(validated(0.0, 0.09), 0U);
  chain_.setInUse(0b11U);
  validated(0.0, -0.09);
  EXPECT_EQ(chain_.fault(), FaultReason::kJump) << "it was in use already";
}

TEST_F(SafetyChainTest, LimitsTheGrowthOfForceButNotItsFall) {
  SafetyConfig config = quickConfig();
  config.slew_n_per_s = 1024.0;  // 1 N per tick
  SafetyChain chain(config, 1, kExactTick);
  const auto limited = [&](double force) {
    chain.limit(&force);
    return force;
  };
  chain.engage();
  for (int n = 0; n < 128; ++n) {
    limited(0.0);
  }
  EXPECT_EQ(limited(10.0), 1.0);
  EXPECT_EQ(limited(10.0), 2.0);
  EXPECT_EQ(limited(0.5), 0.5);
  EXPECT_EQ(limited(-10.0), -1.0);
}

TEST_F(SafetyChainTest, ClampsTheEnergyOfAPortLastOfAll) {
  openFully();
  validated(0.0, 0.0);
  limited(10.0);
  validated(0.0, 0.0);
  EXPECT_EQ(limited(10.0), 10.0) << "it does not move";
  validated(0.001, 0.0);  // the first 10 N gave out 10 mJ, the second are about to do so
  EXPECT_EQ(limited(10.0), 0.0);
  EXPECT_EQ(limited(-10.0), -10.0) << "what takes energy may go on";
  const SliceReading reading = chain_.reading(0);
  EXPECT_EQ(reading.clamped_ticks, 1);
  EXPECT_NEAR(reading.least_energy_j, -0.01, 1e-4);
  EXPECT_EQ(reading.peak_raw_force_n, 10.0);
}

TEST_F(SafetyChainTest, KnowsThatNothingWasSentWhereItDidNotLimit) {
  openFully();
  validated(0.0, 0.0);
  limited(10.0);
  validated(0.0, 0.0);  // 10 N went out and act until the next exchange
  validated(0.001, 0.0);
  validated(0.003, 0.0);
  validated(0.005, 0.0);
  EXPECT_NEAR(chain_.reading(0).least_energy_j, -0.01, 1e-4) << "from the first of these ways only";
}

TEST_F(SafetyChainTest, TakesAForceForNeverSentThatAResumeMutes) {
  openFully();
  validated(0.0, 0.0);
  limited(10.0);
  validated(0.0, 0.0);  // a stall: zeros went out in place of it
  chain_.resume();
  validated(0.001, 0.0);
  validated(0.002, 0.0);
  EXPECT_GE(chain_.reading(0).least_energy_j, 0.0);
}

TEST_F(SafetyChainTest, FaultsWhenTheModelDiverges) {
  openFully();
  double raw = 1.0;
  while (chain_.fault() == FaultReason::kNone) {
    limited(raw);
    raw *= 2.0;
    ASSERT_LE(raw, 128.0);
  }
  EXPECT_EQ(chain_.fault(), FaultReason::kModelBlowUp);
  EXPECT_EQ(chain_.faultSlice(), 0);
  EXPECT_EQ(limited(1.0), 0.0);
}

TEST_F(SafetyChainTest, FaultsWhenTheModelAsksForTooMuch) {
  openFully();
  double raw = 0.0;
  while (chain_.fault() == FaultReason::kNone) {
    limited(raw += 10.0);
  }
  EXPECT_EQ(chain_.fault(), FaultReason::kForceTooHigh);
  EXPECT_EQ(raw, 5010.0);
}

TEST_F(SafetyChainTest, FaultsWhenTheModelPushesTheHandAlong) {
  openFully();
  double x = 0.0;
  double given_out = 0.0;
  while (chain_.fault() == FaultReason::kNone) {
    validated(x += 1e-4, 0.0);
    given_out += 1e-4 * limited(15.0);
    ASSERT_LT(x, 0.09);
  }
  EXPECT_EQ(chain_.fault(), FaultReason::kEnergy);
  EXPECT_LT(given_out, 0.01) << "the clamp held what the detector saw";
}

TEST_F(SafetyChainTest, ForgetsAllOnRecovery) {
  openFully();
  validated(0.0, 0.0);
  limited(10.0);
  validated(0.0, 0.0);
  limited(10.0);
  validated(0.001, 0.0);
  validated(kNan, 0.0);
  ASSERT_LT(chain_.reading(0).least_energy_j, 0.0);
  chain_.recover();
  EXPECT_FALSE(chain_.isOpen());
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
  EXPECT_EQ(chain_.reading(0).least_energy_j, 0.0);
  EXPECT_EQ(chain_.reading(0).peak_raw_force_n, 0.0);
  EXPECT_EQ(validated(-0.09, 0.09), 0U) << "hands may be elsewhere";
  EXPECT_EQ(limited(5.0), 0.0) << "and no force comes by itself";
}

TEST_F(SafetyChainTest, EngagesNeverAfterAFault) {
  validated(kNan, 0.0);
  chain_.engage();
  EXPECT_FALSE(chain_.isOpen());
  chain_.resume();
  EXPECT_EQ(limited(5.0), 0.0);
}

}  // namespace
}  // namespace ergotic::tgr
