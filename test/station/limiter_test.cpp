// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/limiter.hpp"

#include "support/test.hpp"

namespace ergotic::station {
namespace {

constexpr double kFramesPerS = 48000.0;

TEST(LimiterTest, LeavesWhatStaysBelowTheCeilingAsItIs) {
  Limiter limiter(kFramesPerS);
  for (int n = 0; n < 1000; ++n) {
    ASSERT_EQ(limiter.gainFor(0.001F * static_cast<float>(n % 981)), 1.0F);
  }
}

TEST(LimiterTest, LetsNothingBeyondTheCeilingHoweverSuddenOrLoud) {
  Limiter limiter(kFramesPerS);
  for (int n = 0; n < 100'000; ++n) {
    const float peak = n % 7 == 0 ? 28.0F : 0.9F + 0.01F * static_cast<float>(n % 100);
    ASSERT_LE(static_cast<double>(limiter.gainFor(peak) * peak), Limiter::kCeiling * 1.000001) << n;
  }
}

TEST(LimiterTest, ComesBackWithItsTimeConstantAndThenWhole) {
  Limiter limiter(kFramesPerS);
  EXPECT_FLOAT_EQ(limiter.gainFor(28.0F), static_cast<float>(Limiter::kCeiling / 28.0));
  const double away = 1.0 - Limiter::kCeiling / 28.0;
  const auto frames = static_cast<int>(Limiter::kReleaseS * kFramesPerS);
  float gain = 0.0F;
  for (int n = 0; n < frames; ++n) {
    gain = limiter.gainFor(0.0F);
  }
  EXPECT_NEAR(static_cast<double>(gain), 1.0 - away * std::exp(-1.0), 1e-3);
  for (int n = 0; n < 12 * frames; ++n) {
    gain = limiter.gainFor(0.0F);
  }
  EXPECT_EQ(gain, 1.0F) << "to the last bit";
}

}  // namespace
}  // namespace ergotic::station
