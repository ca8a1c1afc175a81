// SPDX-License-Identifier: BSD-3-Clause
// A bag that somebody writes to while it is played.
#include <ergotic/GestureBlock.h>
#include <ergotic/Keyframe.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>

#include "ergotic/bag/recording.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"

namespace ergotic::bag {
namespace {

const ros::Time kStart(1000, 0);

ergotic::GestureBlock block(std::int64_t first_tick) {
  ergotic::GestureBlock message;
  message.first_tick = first_tick;
  message.slices = 2;
  message.ticks = 2;
  message.flags = {0, 0};
  message.positions = {0.1, 0.2, 0.3, 0.4};
  message.ports = 1;
  message.port_positions = {0.5, 0.6};
  return message;
}

ergotic::Keyframe keyframe() {
  ergotic::Keyframe message;
  message.audio_rate = 48000.0;
  message.ratio = 16;
  message.precision = "double";
  message.threads = 1;
  return message;
}

TEST(ChangedRecordingTest, TakesNothingOfABlockThatWasChangedSince) {
  const test::ScratchFile file;
  const auto write = [&file](const ergotic::GestureBlock& first) {
    std_msgs::String other;
    other.data.assign(1'000'000, ' ');  // what is read of one is not still there after the next
    rosbag::Bag bag;
    bag.setChunkThreshold(1);
    bag.open(file.path(), rosbag::bagmode::Write);
    bag.write("/station/gesture", kStart, first);
    bag.write("/chatter", kStart, other);
    bag.write("/station/keyframe", kStart, keyframe());
    bag.write("/station/gesture", kStart, block(14));
    bag.close();
  };
  ergotic::GestureBlock other_ports = block(12);  // of the same number of bytes
  other_ports.slices = 1;
  other_ports.ports = 2;
  std::swap(other_ports.positions, other_ports.port_positions);
  for (const ergotic::GestureBlock& changed : {block(8), other_ports}) {
    write(block(12));
    Recording recording = readRecording(file.path());
    write(changed);
    Stretch& first = recording.stretches[0];
    EXPECT_EQ(complaintOf([&] { recording.load(first); }),
              file.path() + ": the gesture block of tick 12 was changed while it is played");
    EXPECT_TRUE(first.positions.empty() && first.ports_at.empty());
  }
}

}  // namespace
}  // namespace ergotic::bag
