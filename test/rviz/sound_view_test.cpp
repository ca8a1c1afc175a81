// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/sound_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace ergotic::panel {
namespace {

constexpr double kRate = 44100.0;
constexpr std::size_t kFrames = 2048;

std::vector<float> sine(double periods, double amplitude, double phase = 0.0) {
  std::vector<float> block;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double turn = periods * static_cast<double>(i) / kFrames;
    block.push_back(static_cast<float>(amplitude * std::sin(2.0 * M_PI * turn + phase)));
  }
  return block;
}

TEST(SoundViewTest, ASineShowsItsAmplitudeAtItsFrequency) {
  for (const double periods : {10.0, 100.0, 700.0}) {
    const std::vector<double> spectrum = spectrumOf(sine(periods, 0.25, 0.3));
    ASSERT_EQ(spectrum.size(), kFrames / 2 + 1);
    EXPECT_NEAR(spectrum[static_cast<std::size_t>(periods)], 0.25, 1e-6);
    EXPECT_NEAR(spectrum[static_cast<std::size_t>(periods) + 1], 0.125, 1e-6) << "by the window";
    EXPECT_LT(spectrum[static_cast<std::size_t>(periods) + 3], 1e-6);
  }
}

TEST(SoundViewTest, WhatIsNoNumberIsSilence) {
  std::vector<float> block(kFrames, 0.0F);
  block[7] = std::numeric_limits<float>::quiet_NaN();
  block[8] = std::numeric_limits<float>::infinity();
  const std::vector<double> spectrum = spectrumOf(block);
  EXPECT_EQ(*std::max_element(spectrum.begin(), spectrum.end()), 0.0);
}

TEST(SoundViewTest, ColumnsHaveTheLogarithmOfTheFrequency) {
  constexpr int kColumns = 140;
  for (const double periods : {20.0, 93.0, 400.0}) {
    const double hz = periods * kRate / kFrames;
    const std::vector<double> columns = columnsOf(spectrumOf(sine(periods, 0.1)), kRate, kColumns);
    ASSERT_EQ(columns.size(), static_cast<std::size_t>(kColumns));
    const auto largest = std::max_element(columns.begin(), columns.end()) - columns.begin();
    EXPECT_NEAR(static_cast<double>(largest), kColumns * SpectrumScale::shareOf(hz), 3.0);
    EXPECT_NEAR(columns[static_cast<std::size_t>(largest)], -20.0, 0.01);
    EXPECT_GE(*std::min_element(columns.begin(), columns.end()), SpectrumScale::kLowestDb);
  }
  EXPECT_NEAR(SpectrumScale::frequencyAt(SpectrumScale::shareOf(440.0)), 440.0, 1e-9);
}

TEST(SoundViewTest, NothingLiesAboveHalfTheRate) {
  const std::vector<double> all(513, 1.0);
  const std::vector<double> columns = columnsOf(all, 8000.0, 100);
  EXPECT_EQ(columns.front(), 0.0);
  EXPECT_EQ(columns.back(), SpectrumScale::kLowestDb);
  EXPECT_TRUE(columnsOf({}, kRate, 10).empty());
}

TEST(SoundViewTest, AWaveStandsStill) {
  for (const double phase : {0.0, 1.0, 2.5, 4.0}) {
    const std::vector<float> block = sine(16.0, 0.5, phase);
    const std::size_t begin = beginOfWave(block, kFrames / 2);
    ASSERT_LE(begin + kFrames / 2, kFrames);
    EXPECT_NEAR(block[begin], 0.0F, 0.03F);
    EXPECT_GT(block[begin + 5], block[begin]);
  }
  EXPECT_EQ(beginOfWave(std::vector<float>(kFrames, 1.0F), 100), 0U);
  EXPECT_EQ(beginOfWave({}, 100), 0U);
}

}  // namespace
}  // namespace ergotic::panel
