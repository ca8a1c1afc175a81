// SPDX-License-Identifier: BSD-3-Clause
// What a sensor that gives the very same value does to the force of its slice.

#include "ergotic/tgr/safety_chain.hpp"
#include "support/test.hpp"
#include "tgr/sensor_noise.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kForceN = 8.0;

/// Two slices under force; the sensor of the first may stand still, the other never does.
class StillSensorTest : public ::testing::Test {
 protected:
  static SafetyConfig config() {
    SafetyConfig config;
    config.ramp_s = 0.1;
    config.resume_ramp_s = 0.03125;
    config.slew_n_per_s = 1e6;
    config.frozen_s = 0.1;
    return config;
  }
  explicit StillSensorTest(double rate_hz = 3150.0, double frozen_s = config().frozen_s)
      : rate_hz_(rate_hz), chain_(withFrozen(frozen_s), 2, 1.0 / rate_hz) {
    chain_.engage();
    for (int n = 0; n < static_cast<int>(0.2 * rate_hz); ++n) {
      tick(true);
    }
    EXPECT_EQ(forces_, (std::array<double, 2>{kForceN, kForceN}));
  }

  void tick(bool moves) {
    const double to_and_fro = ++ticks_ % 2 == 0 ? 1e-6 : -1e-6;
    x_ = moves ? to_and_fro : x_;
    std::array<double, 2> positions{x_, to_and_fro};
    chain_.validate(positions.data(), kExchangeOk, 0);
    forces_.fill(kForceN);
    chain_.limit(forces_.data());
  }
  /// \return samples of one value until the force of that slice is 0
  int samplesUntilMuted() {
    int samples = 0;
    while (forces_[0] != 0.0 && samples < 10000) {
      tick(false);
      ++samples;
    }
    return samples;
  }

  double rate_hz_;
  SafetyChain chain_;
  std::array<double, 2> forces_{};

 private:
  static SafetyConfig withFrozen(double frozen_s) {
    SafetyConfig changed = config();
    changed.frozen_s = frozen_s;
    return changed;
  }
  double x_ = 0.0;
  int ticks_ = 0;
};

TEST_F(StillSensorTest, MutesItsOwnSliceWithinTenMilliseconds) {
  const int samples = samplesUntilMuted();
  EXPECT_LT(samples / rate_hz_, 0.010);
  EXPECT_GT(samples / rate_hz_, 0.008) << "chance needs time to pass";
  EXPECT_EQ(forces_[1], kForceN);
  EXPECT_EQ(chain_.fault(), FaultReason::kNone);
  EXPECT_EQ(chain_.reading(0).muted_ticks, 1);
  EXPECT_EQ(chain_.reading(1).muted_ticks, 0);
}

TEST_F(StillSensorTest, LetsForceRampUpAgainOnceItMoves) {
  samplesUntilMuted();
  double last = 0.0;
  int ticks = 0;
  while (forces_[0] < kForceN && ticks < 10000) {
    tick(true);
    EXPECT_GE(forces_[0], last);
    EXPECT_LE(forces_[0], last + 1.01 * kForceN / (0.03125 * rate_hz_));
    last = forces_[0];
    ++ticks;
  }
  EXPECT_NEAR(ticks / rate_hz_, 0.03125, 3.0 / rate_hz_);
}

TEST_F(StillSensorTest, IsAFaultIfItGoesOn) {
  samplesUntilMuted();
  while (chain_.fault() == FaultReason::kNone && chain_.reading(0).muted_ticks < 10000) {
    tick(false);
    EXPECT_EQ(forces_[0], 0.0);
  }
  EXPECT_EQ(chain_.fault(), FaultReason::kFrozen);
  EXPECT_EQ(chain_.faultSlice(), 0);
  EXPECT_NEAR(static_cast<double>(chain_.reading(0).muted_ticks) / rate_hz_, 0.091, 0.001);
  EXPECT_EQ(forces_, (std::array<double, 2>{0.0, 0.0}));
}

class SlowStillSensorTest : public StillSensorTest {
 protected:
  SlowStillSensorTest() : StillSensorTest(500.0) {}
};

TEST_F(SlowStillSensorTest, NeedsMoreThanAHandfulOfSamples) {
  EXPECT_EQ(samplesUntilMuted(), 20);
}

class PatientStillSensorTest : public StillSensorTest {
 protected:
  PatientStillSensorTest() : StillSensorTest(3150.0, 0.0) {}
};

TEST_F(PatientStillSensorTest, MayStandStillForEver) {
  for (int n = 0; n < 10000; ++n) {
    tick(false);
  }
  EXPECT_EQ(forces_[0], kForceN);
  EXPECT_EQ(chain_.reading(0).muted_ticks, 0);
}

/// A slice that nothing moves at all, in the middle of a step of its sensor, where samples are the
/// same most often. \param noise  rms, in steps. \return times its force was muted, per second
double mutedByChance(double noise, double seconds) {
  constexpr double kRateHz = 3150.0;
  constexpr double kStepM = 1e-6;
  SafetyConfig config;
  config.frozen_s = 0.1;
  SafetyChain chain(config, 1, 1.0 / kRateHz);
  SensorNoise sensor(3);
  chain.engage();
  int times = 0;
  std::int64_t last = 0;
  for (int n = 0; n < static_cast<int>(seconds * kRateHz); ++n) {
    double x = kStepM * std::round(noise * sensor.next());
    double force = 1.0;
    chain.validate(&x, kExchangeOk, 0);
    chain.limit(&force);
    const std::int64_t muted = chain.reading(0).muted_ticks;
    times += muted == last + 1 && force == 0.0 && x == 0.0 ? 1 : 0;
    last = muted;
  }
  EXPECT_EQ(chain.fault(), FaultReason::kNone);
  return times / seconds;
}

TEST(StillSensorChanceTest, MutesNobodyWhoseSensorIsNoisierThanItsStep) {
  EXPECT_EQ(mutedByChance(1.0, 2000.0), 0.0);
  EXPECT_LT(mutedByChance(0.5, 2000.0), 0.1) << "half a step, as the virtual device has";
}

}  // namespace
}  // namespace ergotic::tgr
