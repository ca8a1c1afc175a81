// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstdio>
#include <thread>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Hold.h>
#include <ergotic/Keyframe.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>

#include "bag/raw_message.hpp"
#include "bag/recorded_message.hpp"
#include "ergotic/bag/positions.hpp"
#include "ergotic/bag/recording.hpp"
#include "ergotic/exception.hpp"
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
  message.flags = {0, ergotic::GestureBlock::CATCH_UP};
  message.positions = {0.1, 0.2, 0.3, 1.0 / 3.0};
  message.forces = {0, 0, 0, 0};
  message.ports = 1;
  message.port_positions = {0.5, 1.0 / 7.0};
  return message;
}

ergotic::Keyframe keyframe() {
  ergotic::Keyframe message;
  message.tick = 12;
  message.scene = "the text";
  message.scene_name = "a.yaml";
  message.build = "0.1.0 abc";
  message.audio_rate = 48000.0;
  message.ratio = 16;
  message.precision = "double";
  message.isa = "avx4096";
  message.threads = 3;
  message.metered = 1;
  message.slices = 2;
  message.state = {1, 2, 3};
  message.parameter_names = {"tone"};
  message.parameter_values = {0.7};
  return message;
}

std::string errorOf(const std::string& path) {
  return complaintOf([&] { readRecording(path); });
}

TEST(ReadRecordingTest, GivesBackEveryFieldInTheOrderOfTicks) {
  const test::ScratchFile file;
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
    std_msgs::String other;
    ergotic::Event parameter;
    parameter.tick = 13;
    parameter.type = ergotic::Event::PARAMETER;
    parameter.index = 1;
    parameter.value = 0.25;
    parameter.frame = -1;
    bag.write("/station/gesture", kStart, block(14));
    bag.write("/chatter", kStart, other);
    bag.write("/station/gesture", kStart, block(12));
    bag.write("/station/events", kStart, parameter);
    bag.write("/station/keyframe", kStart, keyframe());
  }
  Recording recording = readRecording(file.path());
  ASSERT_EQ(recording.stretches.size(), 2U);
  EXPECT_EQ(recording.stretches[0].positions.capacity(), 0U)
      << "an hour of them does not fit in memory";
  recording.load(recording.stretches[0]);
  EXPECT_EQ(recording.stretches[0].first_tick, 12);
  EXPECT_EQ(recording.stretches[1].endTick(), 16);
  EXPECT_EQ(recording.stretches[0].slices, 2U);
  EXPECT_THAT(recording.stretches[0].flags, ElementsAre(0, station::GestureTick::kCatchUp));
  EXPECT_THAT(recording.stretches[0].positions, ElementsAre(0.1, 0.2, 0.3, 1.0 / 3.0));
  EXPECT_EQ(recording.stretches[0].ports, 1U);
  EXPECT_THAT(recording.stretches[0].ports_at, ElementsAre(0.5, 1.0 / 7.0));
  recording.unload(recording.stretches[0]);
  EXPECT_EQ(recording.stretches[0].positions.capacity(), 0U);
  EXPECT_EQ(recording.stretches[0].ports_at.capacity(), 0U);
  ASSERT_EQ(recording.events.size(), 1U);
  EXPECT_EQ(recording.events[0].type, station::Event::Type::kParameter);
  EXPECT_EQ(recording.events[0].tick, 13);
  EXPECT_EQ(recording.events[0].index, 1);
  EXPECT_EQ(recording.events[0].value, 0.25);
  EXPECT_EQ(recording.events[0].frame, -1) << "it is of a model that does not play yet";
  ASSERT_EQ(recording.keyframes.size(), 1U);
  const Keyframe& got = recording.keyframes[0];
  EXPECT_EQ(got.tick, 12);
  EXPECT_EQ(got.scene_text, "the text");
  EXPECT_EQ(got.scene_name, "a.yaml");
  EXPECT_EQ(got.build, "0.1.0 abc");
  EXPECT_EQ(got.rates.audio_hz, 48000.0);
  EXPECT_EQ(got.rates.ratio, 16);
  EXPECT_EQ(got.precision, physics::Precision::kDouble);
  EXPECT_EQ(got.isa, "avx4096");
  EXPECT_EQ(got.threads, 3);
  EXPECT_TRUE(got.metered);
  EXPECT_EQ(got.slices, 2);
  EXPECT_THAT(got.state, ElementsAre(1, 2, 3));
  EXPECT_THAT(got.parameters, ElementsAre(0.7));
}

TEST(ReadRecordingTest, OfSeveralStationsReadsTheOneThatIsChosen) {
  const test::ScratchFile file;
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
    for (const std::string name : {"/left", "/stage/right"}) {
      bag.write(name + "/gesture", kStart, block(name == "/left" ? 12 : 40));
      bag.write(name + "/keyframe", kStart, keyframe());
    }
  }
  EXPECT_THAT(errorOf(file.path()), HasSubstr("several stations, say which: /left, /stage/right"));
  EXPECT_THAT(complaintOf([&] { readRecording(file.path(), "/none"); }),
              HasSubstr("no gesture of a station /none in this bag, allowed: /left, /stage/right"));
  const Recording recording = readRecording(file.path(), "stage/right");
  ASSERT_EQ(recording.stretches.size(), 1U);
  EXPECT_EQ(recording.stretches[0].first_tick, 40);
  EXPECT_EQ(readRecording(file.path(), "/left").stretches.at(0).first_tick, 12);
}

TEST(ReadRecordingTest, SaysWhatIsMissing) {
  const test::ScratchFile file;
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
    bag.write("/station/gesture", kStart, block(0));
  }
  EXPECT_THAT(errorOf(file.path()), HasSubstr("no keyframe"));
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
    bag.write("/station/keyframe", kStart, keyframe());
  }
  EXPECT_THAT(errorOf(file.path()), HasSubstr("no gesture"));
}

TEST(ReadRecordingTest, RefusesABlockThatContradictsItself) {
  const test::ScratchFile file;
  const auto refusalOf = [&](const ergotic::GestureBlock& wrong) {
    {
      rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
      bag.write("/station/gesture", kStart, wrong);
    }
    return errorOf(file.path());
  };
  ergotic::GestureBlock wrong = block(40);
  wrong.positions.pop_back();
  EXPECT_THAT(refusalOf(wrong), HasSubstr("block of tick 40 has 3 positions"));
  wrong = block(40);
  wrong.port_positions.clear();
  EXPECT_THAT(refusalOf(wrong),
              HasSubstr("block of tick 40 has 0 positions for 2 ticks of 1 ports"));
}

TEST(ReadRecordingTest, RefusesAKeyframeThatNoInstrumentCanContinue) {
  const test::ScratchFile file;
  const auto refusalOf = [&](const ergotic::Keyframe& wrong) {
    {
      rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
      bag.write("/station/gesture", kStart, block(12));
      bag.write("/station/keyframe", kStart, wrong);
    }
    return errorOf(file.path());
  };
  ergotic::Keyframe half = keyframe();
  half.precision = "half";
  EXPECT_THAT(refusalOf(half), HasSubstr("precision 'half', allowed: float, double"));
  for (const unsigned threads : {0U, 9U}) {
    ergotic::Keyframe wrong = keyframe();
    wrong.threads = threads;
    EXPECT_THAT(refusalOf(wrong), HasSubstr("keyframe of tick 12: its number of threads is " +
                                            std::to_string(threads) + ", allowed: 1...8"));
  }
  const std::pair<const char*, void (*)(ergotic::Keyframe&)> damages[] = {
      {"tick -1: its tick is -1, allowed: 0...1e+15", [](auto& k) { k.tick = -1; }},
      {"its audio rate (Hz) is nan, allowed: 8000...192000",
       [](auto& k) { k.audio_rate = std::nan(""); }},
      {"its number of frames per tick is 0, allowed: 1...48", [](auto& k) { k.ratio = 0; }},
      {"is 4.29497e+09, allowed: 1...48", [](auto& k) { k.ratio = 0xFFFFFFFFU; }},
      {"its number of slices is 65, allowed: 0...64", [](auto& k) { k.slices = 65; }},
      {"parameter 0 at its row 0 is inf, allowed: finite numbers",
       [](auto& k) { k.parameter_values = {std::numeric_limits<double>::infinity()}; }},
  };
  for (const auto& [words, damage] : damages) {
    ergotic::Keyframe wrong = keyframe();
    damage(wrong);
    EXPECT_THAT(refusalOf(wrong), HasSubstr(words));
  }
}

TEST(ReadRecordingTest, RefusesPositionsAndEventsThatAreNoNumbers) {
  const test::ScratchFile file;
  const auto refusalOf = [&](const ergotic::GestureBlock& gesture, const ergotic::Event& event) {
    {
      rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
      bag.write("/station/gesture", kStart, gesture);
      bag.write("/station/events", kStart, event);
    }
    return errorOf(file.path());
  };
  ergotic::GestureBlock slice = block(12);
  slice.positions[3] = std::nan("");
  EXPECT_THAT(refusalOf(slice, {}), HasSubstr("block of tick 12: the position of slice 1 at its "
                                              "row 1 is nan, allowed: finite numbers"));
  ergotic::GestureBlock port = block(12);
  port.port_positions[1] = -std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusalOf(port, {}), HasSubstr("the position of port 0 at its row 1 is -inf"));
  ergotic::GestureBlock flags = block(12);
  flags.flags.pop_back();
  EXPECT_THAT(refusalOf(flags, {}), HasSubstr("has 1 flags for 2 ticks"));
  EXPECT_THAT(refusalOf(block(-5), {}), HasSubstr("its tick is -5, allowed: 0...1e+15"));
  ergotic::Event event;
  event.tick = 13;
  event.value = std::nan("");
  EXPECT_THAT(refusalOf(block(12), event), HasSubstr("event of tick 13: value 0"));
  event.value = 0.0;
  event.index = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(refusalOf(block(12), event), HasSubstr("its index is 9.22337e+18, allowed: "));
}

TEST(ReadRecordingTest, RefusesHandsThatHoldWhatNoStationCanHaveRecorded) {
  const test::ScratchFile file;
  const auto refusalOf = [&](const auto& damage) {
    ergotic::Hold hold;
    hold.tick = 13;
    damage(hold);
    {
      rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
      bag.write("/station/gesture", kStart, block(12));
      bag.write("/station/keyframe", kStart, keyframe());
      bag.write("/station/holds", kStart, hold);
    }
    return errorOf(file.path());
  };
  EXPECT_EQ(refusalOf([](auto&) {}), "");
  EXPECT_THAT(refusalOf([](auto& h) { h.hand = 4; }),
              HasSubstr("hold of tick 13: its hand is 4, allowed: 0...3"));
  EXPECT_THAT(refusalOf([](auto& h) { h.module = -2; }), HasSubstr("its module is -2"));
  EXPECT_THAT(refusalOf([](auto& h) { h.ticks_left = -1; }), HasSubstr("its ticks_left is -1"));
  EXPECT_THAT(refusalOf([](auto& h) { h.damping = -1.0; }), HasSubstr("its damping is -1"));
  EXPECT_THAT(refusalOf([](auto& h) { h.most_force = std::nan(""); }),
              HasSubstr("its most_force is nan"));
  EXPECT_THAT(refusalOf([](auto& h) { h.goal[1] = std::nan(""); }),
              HasSubstr("coordinate of the goal 1"));
}

std::vector<std::uint8_t> bytesOf(const ergotic::GestureBlock& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  return bytes;
}

TEST(ReadRecordingTest, RefusesMessagesThatAreCutShort) {
  const test::ScratchFile file;
  const auto refusalOf = [&](const std::vector<std::uint8_t>& bytes, std::size_t size) {
    {
      rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
      bag.write("/station/gesture", kStart, rawMessage<ergotic::GestureBlock>(bytes.data(), size));
    }
    return errorOf(file.path());
  };
  const std::vector<std::uint8_t> whole = bytesOf(block(0));
  for (std::size_t size = 0; size < whole.size(); size += 3) {
    EXPECT_THAT(refusalOf(whole, size), HasSubstr("is cut short")) << size;
  }
  EXPECT_THAT(refusalOf(whole, whole.size()), HasSubstr("no keyframe"));
  std::vector<std::uint8_t> greedy = whole;
  constexpr std::size_t kFlags = 40;  // where their number is
  std::fill_n(greedy.begin() + kFlags, 4, 0xFF);
  EXPECT_THAT(refusalOf(greedy, greedy.size()), HasSubstr("is cut short"))
      << "and no room is made for 16 GB";
}

TEST(ReadRecordingTest, RefusesAGapThatWouldBePlayedForYears) {
  const test::ScratchFile file;
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
    bag.write("/station/gesture", kStart, block(0));
    bag.write("/station/gesture", kStart, block(1'000'000'000'000));
    bag.write("/station/keyframe", kStart, keyframe());
  }
  EXPECT_THAT(errorOf(file.path()),
              HasSubstr("block of tick 1000000000000: the number of ticks between it and the one "
                        "before is 1e+12, allowed: 0...1e+08"));
}

TEST(ReadRecordingTest, RefusesWhatIsNoBag) {
  const test::ScratchFile text("no bag at all");
  EXPECT_THAT(errorOf(text.path()), HasSubstr(text.path()));
  EXPECT_THAT(errorOf("/nonexistent.bag"), HasSubstr("/nonexistent.bag"));
}

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
  keyframe.audio_rate = 48000.0;
  keyframe.ratio = 16;
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

TEST(BagPositionsTest, AreReadWhileTheyArePlayed) {
  constexpr int kBlocks = 400;
  constexpr int kBlockTicks = 64;
  const test::ScratchFile file;
  std::vector<GestureBlock> blocks;
  for (int n = 0; n < kBlocks; ++n) {
    std::vector<double> positions;
    for (int tick = n * kBlockTicks; tick < (n + 1) * kBlockTicks; ++tick) {
      positions.insert(positions.end(), {1e-6 * tick, 1.0 / (1.0 + tick)});
    }
    blocks.push_back(block(n * kBlockTicks, positions));
  }
  write(file.path(), blocks);
  const auto source = readPositions(file.path());
  std::size_t there = 0;
  for (int tick = 0; tick < kBlocks * kBlockTicks; ++tick) {
    std::array<double, 2> positions{};
    if (source->next(positions.data())) {  // a tick that comes late is left out
      ++there;
      ASSERT_EQ(positions, (std::array<double, 2>{1e-6 * tick, 1.0 / (1.0 + tick)}));
    }
    if (tick % 1000 == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
  }
  EXPECT_GT(there, 2 * tgr::kTicksAhead);
}

TEST(BagPositionsTest, EndWhereTheFileCannotBeReadAnyMore) {
  Recording recording;
  recording.stretches.resize(2);
  for (Stretch& stretch : recording.stretches) {
    stretch.slices = 1;
    stretch.flags = {0};
  }
  recording.stretches[1].first_tick = 1;
  recording.load = [](Stretch& stretch) {
    if (stretch.first_tick == 1) {
      throw Exception("the disk is gone");
    }
    stretch.positions = {0.1};
  };
  const auto source = positionsOf(recording, "a.bag");
  double x = 0.0;
  EXPECT_TRUE(source->next(&x));
  EXPECT_FALSE(source->next(&x));
  EXPECT_FALSE(source->next(&x));
  EXPECT_EQ(x, 0.1);
}

TEST(BagPositionsTest, AreRefusedWhenTheNumberOfSlicesChanges) {
  const test::ScratchFile file;
  GestureBlock wide = block(6, {0.1, 0.2, 0.3, 0.4});
  wide.slices = 4;
  wide.ticks = 1;
  wide.flags.resize(1);
  write(file.path(), {block(5, {0.1, 0.2}), wide});
  EXPECT_THAT(complaintOf([&] { readPositions(file.path()); }),
              HasSubstr("tick 6 has 4 slices, allowed: 2"));
}

}  // namespace
}  // namespace ergotic::bag
