// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/take_port.hpp"

#include "support/test.hpp"

namespace ergotic::station {
namespace {

constexpr double kRateHz = 48000.0;
constexpr int kFade = 240;  // frames, TakePort::kFadeS of them

/// Two channels: the number of the frame, and its negative.
std::vector<float> frames(int first, int count) {
  std::vector<float> sound;
  for (int i = first; i < first + count; ++i) {
    sound.push_back(static_cast<float>(i));
    sound.push_back(static_cast<float>(-i));
  }
  return sound;
}

TEST(TakePortTest, GivesBackWhatWasWrittenBitForBitAfterAFadeIn) {
  TakePort port(1000, 2, kRateHz);
  port.open();
  ASSERT_TRUE(port.push(frames(0, 1000).data(), 1000));
  float gain = 0.0F;
  float before = 0.0F;
  for (int i = 0; i < 1000; ++i) {
    const float* frame = port.next(gain);
    ASSERT_NE(frame, nullptr) << i;
    EXPECT_EQ(frame[0], static_cast<float>(i));
    EXPECT_EQ(frame[1], static_cast<float>(-i));
    EXPECT_LE(gain - before, 1.001F / kFade) << "steps are heard";
    EXPECT_TRUE(i <= kFade || gain == 1.0F) << i;
    before = gain;
  }
  EXPECT_EQ(port.next(gain), nullptr);
  EXPECT_EQ(port.sounded(), 1000);
  EXPECT_TRUE(port.isSilent());
}

TEST(TakePortTest, TakesNothingWithoutRoomAndGoesOnWhereItPaused) {
  TakePort port(10, 2, kRateHz);
  port.open();
  ASSERT_TRUE(port.push(frames(0, 8).data(), 8));
  EXPECT_FALSE(port.push(frames(8, 3).data(), 3));
  float gain = 0.0F;
  for (int i = 0; i < 8; ++i) {
    ASSERT_NE(port.next(gain), nullptr);
  }
  EXPECT_EQ(port.next(gain), nullptr) << "the writer is late";
  ASSERT_TRUE(port.push(frames(8, 3).data(), 3));
  const float* frame = port.next(gain);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame[0], 8.0F) << "nothing of a take is left out";
}

TEST(TakePortTest, FadesOutAndDropsTheRestWhenItIsClosed) {
  TakePort port(2000, 2, kRateHz);
  port.open();
  ASSERT_TRUE(port.push(frames(0, 2000).data(), 2000));
  float gain = 0.0F;
  for (int i = 0; i < 500; ++i) {
    port.next(gain);
  }
  port.close();
  int faded = 0;
  while (port.next(gain) != nullptr) {
    ++faded;
  }
  EXPECT_NEAR(faded, kFade, 1);
  EXPECT_NEAR(gain, 0.0F, 1e-4F);
  EXPECT_TRUE(port.isSilent());
  port.open();
  EXPECT_EQ(port.next(gain), nullptr);
  ASSERT_TRUE(port.push(frames(7, 1).data(), 1));
  EXPECT_EQ(port.next(gain)[0], 7.0F);
  EXPECT_NEAR(gain, 1.0F / kFade, 1e-4F) << "the next take fades in as well";
}

TEST(TakePortTest, IsSilentWhereNothingWasOpened) {
  TakePort port(10, 2, kRateHz);
  float gain = 0.0F;
  EXPECT_EQ(port.next(gain), nullptr);
  ASSERT_TRUE(port.push(frames(0, 5).data(), 5));
  EXPECT_EQ(port.next(gain), nullptr);
  EXPECT_TRUE(port.isSilent());
}

}  // namespace
}  // namespace ergotic::station
