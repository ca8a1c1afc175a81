// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/bag/positions.hpp"

#include <array>

#include <ergotic/GestureBlock.h>
#include <ergotic/Keyframe.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include "ergotic/exception.hpp"
#include "support/scratch_file.hpp"

namespace ergotic::bag {
namespace {

GestureBlock block(std::int64_t first_tick, const std::vector<double>& positions) {
  GestureBlock message;
  message.first_tick = first_tick;
  message.slices = 2;
  message.ticks = static_cast<std::uint32_t>(positions.size() / 2);
  message.flags.resize(message.ticks);
  message.positions = positions;
  message.forces.resize(positions.size());
  return message;
}

void write(const std::string& path, const std::vector<GestureBlock>& blocks) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  const ros::Time now(1000, 0);
  ergotic::Keyframe keyframe;
  keyframe.precision = "double";
  keyframe.threads = 1;
  bag.write("/station/keyframe", now, keyframe);
  for (const GestureBlock& message : blocks) {
    bag.write("/station/gesture", now, message);
  }
}

TEST(BagPositionsTest, ComeBackBitForBitAndAreHeldOverTicksThatNeverRan) {
  const test::ScratchFile file;
  write(file.path(), {block(5, {0.1, 1.0 / 3.0, 0.2, 0.5}), block(9, {0.3, 0.7})});
  const auto source = readPositions(file.path());
  ASSERT_EQ(source->slices(), 2);
  const std::vector<std::array<double, 2>> expected{
      {0.1, 1.0 / 3.0}, {0.2, 0.5}, {0.2, 0.5}, {0.2, 0.5}, {0.3, 0.7}};
  std::array<double, 2> positions{};
  for (const auto& tick : expected) {
    ASSERT_TRUE(source->next(positions.data()));
    EXPECT_EQ(positions, tick);
  }
  EXPECT_FALSE(source->next(positions.data()));
  EXPECT_FALSE(source->next(positions.data()));
  EXPECT_EQ(positions, expected.back());
}

TEST(BagPositionsTest, AreRefusedWhenTheNumberOfSlicesChanges) {
  const test::ScratchFile file;
  GestureBlock wide = block(6, {0.1, 0.2, 0.3, 0.4});
  wide.slices = 4;
  wide.ticks = 1;
  wide.flags.resize(1);
  write(file.path(), {block(5, {0.1, 0.2}), wide});
  try {
    readPositions(file.path());
    FAIL() << "was read";
  } catch (const Exception& refusal) {
    EXPECT_THAT(refusal.what(), testing::HasSubstr("tick 6 has 4 slices, allowed: 2"));
  }
}

}  // namespace
}  // namespace ergotic::bag
