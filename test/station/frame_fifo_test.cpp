// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/frame_fifo.hpp"

#include "support/test.hpp"

namespace ergotic::station {
namespace {

constexpr std::array<float, 8> kFrames{1, -1, 2, -2, 3, -3, 4, -4};

TEST(FrameFifoTest, GivesEachFrameUnderItsIndex) {
  FrameFifo fifo(16, 2);
  ASSERT_TRUE(fifo.push(100, kFrames.data(), 4));
  for (int i = 0; i < 4; ++i) {
    const float* frame = fifo.take(100 + i);
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame[0], static_cast<float>(i + 1));
    EXPECT_EQ(frame[1], static_cast<float>(-i - 1));
  }
  EXPECT_EQ(fifo.take(104), nullptr);
}

TEST(FrameFifoTest, DiscardsWhatIsOlderAndKeepsWhatIsNewer) {
  FrameFifo fifo(16, 2);
  fifo.push(100, kFrames.data(), 2);
  fifo.push(110, kFrames.data() + 4, 2);
  EXPECT_EQ(fifo.take(105), nullptr) << "in the gap";
  ASSERT_NE(fifo.take(111), nullptr);
  EXPECT_EQ(fifo.take(111), nullptr) << "given once";
}

TEST(FrameFifoTest, RefusesWhatDoesNotFitUntilRoomIsGivenBack) {
  FrameFifo fifo(5, 2);
  EXPECT_TRUE(fifo.push(0, kFrames.data(), 4));
  EXPECT_FALSE(fifo.push(4, kFrames.data(), 4));
  fifo.take(2);
  EXPECT_FALSE(fifo.push(4, kFrames.data(), 4)) << "not yet released";
  fifo.release();
  EXPECT_TRUE(fifo.push(4, kFrames.data(), 4));  // wraps around
  ASSERT_NE(fifo.take(7), nullptr);
  EXPECT_EQ(fifo.take(8), nullptr);
}

TEST(FrameFifoTest, ClearsEverything) {
  FrameFifo fifo(4, 2);
  fifo.push(0, kFrames.data(), 4);
  fifo.clear();
  EXPECT_EQ(fifo.take(3), nullptr);
  EXPECT_TRUE(fifo.push(4, kFrames.data(), 4));
}

}  // namespace
}  // namespace ergotic::station
