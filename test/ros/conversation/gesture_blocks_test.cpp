// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/gesture_blocks.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>

namespace ergotic::node {
namespace {

station::GestureTick tickAt(std::int64_t number) {
  station::GestureTick tick;
  tick.tick = number;
  tick.slices = 2;
  tick.flags = number % 2 == 0 ? 0U : std::uint32_t{station::GestureTick::kHeld};
  tick.position[0] = 1.0 / static_cast<double>(number + 1);
  tick.position[1] = -tick.position[0];
  tick.force[1] = static_cast<float>(number);
  tick.ports = 1;
  tick.port[0] = 3.0 * tick.position[0];
  return tick;
}

TEST(GestureBlocksTest, HoldAtMostSixtyFourTicksAndTwentyMilliseconds) {
  EXPECT_EQ(GestureBlocks(3150.0).ticksPerBlock(), 63U);
  EXPECT_EQ(GestureBlocks(44100.0).ticksPerBlock(), 64U);
  EXPECT_EQ(GestureBlocks(200.0).ticksPerBlock(), 4U);
  EXPECT_EQ(GestureBlocks(10.0).ticksPerBlock(), 1U);
}

TEST(GestureBlocksTest, KeepEveryTickInOrderBitForBit) {
  GestureBlocks blocks(3150.0);
  std::int64_t next = 5;
  for (std::int64_t n = 5; n < 5 + 10 * 63; ++n) {
    const auto block = blocks.add(tickAt(n));
    ASSERT_EQ(block.has_value(), (n - 4) % 63 == 0);
    if (!block) {
      continue;
    }
    GestureBlock received;
    ::ros::serialization::deserializeMessage(::ros::serialization::serializeMessage(*block),
                                             received);
    EXPECT_EQ(received.first_tick, next);
    EXPECT_EQ(received.tick_rate_hz, 3150.0);
    ASSERT_EQ(received.ticks, 63U);
    for (std::size_t i = 0; i < received.ticks; ++i, ++next) {
      const station::GestureTick tick = tickAt(next);
      EXPECT_EQ(received.flags[i], tick.flags);
      EXPECT_EQ(received.positions[2 * i], tick.position[0]);
      EXPECT_EQ(received.positions[2 * i + 1], tick.position[1]);
      EXPECT_EQ(received.forces[2 * i + 1], tick.force[1]);
      EXPECT_EQ(received.port_positions[i], tick.port[0]);
    }
  }
}

TEST(GestureBlocksTest, BreakOffAtAGap) {
  GestureBlocks blocks(3150.0);
  EXPECT_FALSE(blocks.add(tickAt(0)));
  EXPECT_FALSE(blocks.add(tickAt(1)));
  const auto before = blocks.add(tickAt(7));
  ASSERT_TRUE(before);
  EXPECT_EQ(before->first_tick, 0);
  EXPECT_EQ(before->ticks, 2U);
  for (std::int64_t n = 8; n < 7 + 62; ++n) {
    EXPECT_FALSE(blocks.add(tickAt(n)));
  }
  const auto after = blocks.add(tickAt(7 + 62));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->first_tick, 7);
  EXPECT_EQ(after->ticks, 63U);
}

TEST(GestureBlocksTest, LoseNothingWhenAGapMeetsBlocksOfOneTick) {
  GestureBlocks blocks(10.0);
  EXPECT_EQ(blocks.add(tickAt(0))->first_tick, 0);
  EXPECT_EQ(blocks.add(tickAt(5))->first_tick, 5);
}

}  // namespace
}  // namespace ergotic::node
