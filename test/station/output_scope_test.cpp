// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/output_scope.hpp"

#include "support/realtime_scope.hpp"
#include "support/test.hpp"

namespace ergotic::station {
namespace {

constexpr std::size_t kFrames = OutputScope::kFrames;

/// Frames of two channels, whose samples tell when they were: number, and minus number.
void play(OutputScope& scope, std::size_t first, std::size_t count, float gain = 1.0F) {
  for (std::size_t i = first; i < first + count; ++i) {
    const float frame[] = {static_cast<float>(i), -static_cast<float>(i)};
    scope.take(frame, 2, gain);
  }
}

TEST(OutputScopeTest, ShowsWholeBlocksWithoutGaps) {
  OutputScope scope(2);
  scope.watch(true);
  play(scope, 0, kFrames - 1);
  EXPECT_FALSE(scope.refresh());
  play(scope, kFrames - 1, kFrames, 0.5F);
  ASSERT_TRUE(scope.refresh());
  EXPECT_FALSE(scope.refresh());
  const std::vector<float>& block = scope.latest();
  ASSERT_EQ(block.size(), 2 * kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const float wanted = (i + 1 < kFrames ? 1.0F : 0.5F) * static_cast<float>(i);
    EXPECT_EQ(block[i], wanted);
    EXPECT_EQ(block[kFrames + i], -wanted);
  }
}

TEST(OutputScopeTest, ShowsNothingThatWasNotWanted) {
  OutputScope scope(2);
  play(scope, 0, 3 * kFrames);
  EXPECT_FALSE(scope.refresh());
  scope.watch(true);
  play(scope, 0, kFrames / 2);
  scope.watch(false);
  play(scope, 0, 1);
  scope.watch(true);
  play(scope, 100, kFrames);  // a block has no gap
  ASSERT_TRUE(scope.refresh());
  EXPECT_EQ(scope.latest()[0], 100.0F);
}

TEST(OutputScopeTest, WhatIsMissingIsSilence) {
  OutputScope scope(2);
  scope.watch(true);
  play(scope, 1, kFrames);
  const float one = 7.0F;
  scope.take(nullptr, 2, 1.0F);
  for (std::size_t i = 1; i < kFrames; ++i) {
    scope.take(&one, 1, 1.0F);
  }
  ASSERT_TRUE(scope.refresh());
  EXPECT_EQ(scope.latest()[0], 0.0F);
  EXPECT_EQ(scope.latest()[1], 7.0F);
  EXPECT_EQ(scope.latest()[kFrames + 1], 0.0F);
}

TEST(OutputScopeTest, RunsInTheSoundsThread) {
  OutputScope scope(2);
  scope.watch(true);
  test::expectRealtime([&] { play(scope, 0, 3 * kFrames); });
}

}  // namespace
}  // namespace ergotic::station
