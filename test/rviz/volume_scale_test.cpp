// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/volume_scale.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace ergotic::panel {
namespace {

TEST(VolumeScaleTest, TheEndsAreSilenceAndFullVolume) {
  EXPECT_EQ(volumeAt(0), 0.0);
  EXPECT_EQ(volumeAt(kVolumeSteps), 1.0);
  EXPECT_NEAR(volumeAt(kVolumeSteps - 2), std::pow(10.0, -1.0 / 20.0), 1e-12)
      << "half a decibel a step";
}

TEST(VolumeScaleTest, StepsComeBackFromTheirVolumes) {
  for (int step = 0; step <= kVolumeSteps; ++step) {
    EXPECT_EQ(stepOfVolume(volumeAt(step)), step == 0 ? 0 : step);
  }
}

TEST(VolumeScaleTest, AMeterShowsSixtyDecibels) {
  EXPECT_EQ(shareOfDecibels(1.0), 1.0);
  EXPECT_EQ(shareOfDecibels(28.0), 1.0);
  EXPECT_NEAR(shareOfDecibels(std::pow(10.0, -1.5)), 0.5, 1e-12);
  EXPECT_EQ(shareOfDecibels(1e-4), 0.0);
  EXPECT_EQ(shareOfDecibels(0.0), 0.0);
  EXPECT_EQ(shareOfDecibels(std::numeric_limits<double>::quiet_NaN()), 0.0);
}

}  // namespace
}  // namespace ergotic::panel
