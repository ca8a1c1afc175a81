// SPDX-License-Identifier: BSD-3-Clause
#include "audio/recorder.hpp"

#include <unistd.h>

#include <cstdio>

#include "audio/frame_counter.hpp"
#include "support/test.hpp"

namespace ergotic::audio {
namespace {

constexpr std::uint32_t kPeriod = 16;
constexpr std::int64_t kNoLimit = INT64_MAX;

/// A recorder with two channels and room for four periods, fed by hand.
class RecorderTest : public testing::Test {
 protected:
  RecorderTest() { recorder_.audioStarted(44100.0, kPeriod); }
  ~RecorderTest() override { std::remove(path_.c_str()); }

  /// Channel 1 holds the frame time, channel 2 its negative.
  void feed(std::int64_t start) { feed(start, start); }

  /// \param told  frame time that JACK claims
  void feed(std::int64_t start, std::int64_t told) {
    std::vector<float> up(kPeriod);
    std::vector<float> down(kPeriod);
    for (std::size_t i = 0; i < kPeriod; ++i) {
      up[i] = static_cast<float>(start + static_cast<std::int64_t>(i));
      down[i] = -up[i];
    }
    const float* channels[] = {up.data(), down.data()};
    rt::Period period;
    period.nframes = kPeriod;
    period.start.frames = told;
    period.inputs = channels;
    period.input_channels = 2;
    recorder_.process(period);
  }

  std::vector<double> recorded(std::int64_t limit = kNoLimit) {
    recorder_.finish(file_, limit);
    file_.finish();
    return WavReader(path_).readAll();
  }

  std::string path_ = testing::TempDir() + "ergotic_recorder_" + std::to_string(getpid()) + ".wav";
  Recorder recorder_{2, 4 * kPeriod};
  WavWriter file_{path_, 44100.0, 2, WavFormat::kFloat};
};

/// What a file of `nframes` from `first` must hold, zeros in [gap, gap_end).
std::vector<double> ramp(std::int64_t first,
                         std::int64_t nframes,
                         std::int64_t gap,
                         std::int64_t gap_end) {
  std::vector<double> expected;
  for (std::int64_t frame = first; frame < first + nframes; ++frame) {
    const double value = frame >= gap && frame < gap_end ? 0.0 : static_cast<double>(frame);
    expected.push_back(value);
    expected.push_back(-value);
  }
  return expected;
}

TEST_F(RecorderTest, FilePositionIsFrameTime) {
  feed(1000);
  feed(1016);
  recorder_.drain(file_, kNoLimit);
  feed(1032);
  recorder_.drain(file_, kNoLimit);
  EXPECT_EQ(recorder_.firstFrame(), 1000);
  EXPECT_EQ(recorded(), ramp(1000, 48, 0, 0));
}

TEST_F(RecorderTest, LostCyclesAreZerosAndCounted) {
  feed(1000);
  feed(1064);
  EXPECT_EQ(recorded(), ramp(1000, 80, 1016, 1064));
  EXPECT_EQ(recorder_.lostFrames(), 48);
  EXPECT_EQ(recorder_.droppedFrames(), 0);
}

TEST_F(RecorderTest, BlocksThatFindTheRingFullAreDroppedNotLost) {
  for (std::int64_t period = 0; period < 6; ++period) {
    feed(1000 + period * kPeriod);
  }
  recorder_.drain(file_, kNoLimit);
  feed(1000 + 6 * kPeriod);
  feed(1000 + 8 * kPeriod);
  std::vector<double> expected = ramp(1000, 9 * kPeriod, 1000 + 4 * kPeriod, 1000 + 6 * kPeriod);
  const auto lost = expected.begin() + 2 * 7 * kPeriod;
  std::fill(lost, lost + 2 * kPeriod, 0.0);
  EXPECT_EQ(recorded(), expected);
  EXPECT_EQ(recorder_.droppedFrames(), 2 * kPeriod);
  EXPECT_EQ(recorder_.lostFrames(), kPeriod);
}

TEST_F(RecorderTest, ALateBlockGoesWhereItBelongs) {
  feed(1000);
  feed(1016, 1032);
  recorder_.drain(file_, kNoLimit);
  feed(1032);
  feed(1048);
  EXPECT_EQ(recorded(), ramp(1000, 64, 0, 0));
  EXPECT_EQ(recorder_.lostFrames(), 0);
  EXPECT_EQ(recorder_.droppedFrames(), 0);
}

TEST_F(RecorderTest, ABlockWithoutAPlaceIsDropped) {
  feed(1000);
  feed(1016);
  feed(1008);
  feed(1032);
  EXPECT_EQ(recorded(), ramp(1000, 48, 0, 0));
  EXPECT_EQ(recorder_.droppedFrames(), kPeriod);
}

TEST_F(RecorderTest, StopsExactlyAtItsLimit) {
  feed(1000);
  feed(1016);
  feed(1032);
  recorder_.drain(file_, 20);
  EXPECT_EQ(file_.frames(), 20);
  feed(1048);
  EXPECT_EQ(recorded(20), ramp(1000, 20, 0, 0));
}

TEST_F(RecorderTest, ALimitInsideAGapEndsInZeros) {
  feed(1000);
  feed(1064);
  EXPECT_EQ(recorded(30), ramp(1000, 30, 1016, 1064));
  EXPECT_EQ(recorder_.lostFrames(), 14);
}

TEST_F(RecorderTest, AFrameTimeThatJumpsOutOfReachEndsTheRecording) {
  constexpr std::int64_t kStart = 100 * 44100;
  feed(kStart);
  feed(kStart + 61 * 44100);
  EXPECT_THROW(recorder_.finish(file_, kNoLimit), Exception);
  feed(kStart - 61 * 44100);
  EXPECT_THROW(recorder_.finish(file_, kNoLimit), Exception);
  file_.finish();
  EXPECT_EQ(WavReader(path_).readAll(), ramp(kStart, 16, 0, 0));
}

TEST(FrameCounterTest, GoesOnWhereJacksCountWraps) {
  FrameCounter counter;
  EXPECT_EQ(counter.extend(0xFFFF'FF00U), 0xFFFF'FF00LL);
  EXPECT_EQ(counter.extend(0x0000'0000U), 0x1'0000'0000LL);
  EXPECT_EQ(counter.extend(0x0000'0100U), 0x1'0000'0100LL);
  EXPECT_EQ(counter.extend(0x0000'0000U), 0x1'0000'0000LL);
  std::uint32_t frame = 0;
  for (int i = 0; i < 8; ++i) {
    frame += 0x4000'0000U;
    counter.extend(frame);
  }
  EXPECT_EQ(counter.extend(frame), 0x3'0000'0000LL);
}

}  // namespace
}  // namespace ergotic::audio
