// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/disturbances.hpp"

#include "support/test.hpp"

namespace ergotic::node {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

Event eventOf(std::uint8_t type) {
  Event event;
  event.type = type;
  return event;
}

TEST(DisturbancesTest, AreLateTicksStallsAndMissingSound) {
  for (const std::uint8_t type :
       {Event::LATE_TICK, Event::STALL, Event::UNDERRUN, Event::AUDIO_SKIPPED}) {
    EXPECT_TRUE(Disturbances::isOne(eventOf(type)));
  }
  EXPECT_FALSE(Disturbances::isOne(eventOf(Event::FAULT)));
  EXPECT_FALSE(Disturbances::isOne(eventOf(Event::PLAYING)));
}

TEST(DisturbancesTest, AreToldOnceOfEachKindAndThenCountedOnceAMinute) {
  Disturbances disturbances;
  EXPECT_EQ(disturbances.ofLastMinute(kSecondNs), "");
  EXPECT_TRUE(disturbances.isFirst(eventOf(Event::LATE_TICK)));
  EXPECT_TRUE(disturbances.isFirst(eventOf(Event::STALL)));
  for (int n = 0; n < 3; ++n) {
    EXPECT_FALSE(disturbances.isFirst(eventOf(Event::LATE_TICK)));
  }
  EXPECT_EQ(disturbances.ofLastMinute(60 * kSecondNs), "") << "not yet";
  EXPECT_EQ(disturbances.ofLastMinute(61 * kSecondNs), "in the last minute: 3 late ticks");
  EXPECT_EQ(disturbances.ofLastMinute(62 * kSecondNs), "");
  EXPECT_FALSE(disturbances.isFirst(eventOf(Event::LATE_TICK)));
  EXPECT_FALSE(disturbances.isFirst(eventOf(Event::STALL)));
  EXPECT_EQ(disturbances.ofLastMinute(121 * kSecondNs),
            "in the last minute: 1 late ticks, 1 stalls");
  EXPECT_EQ(disturbances.ofLastMinute(181 * kSecondNs), "") << "nothing happened";
}

/// So many frames are missing from one on.
Event underrun(std::int64_t frame, std::int64_t frames) {
  Event event = eventOf(Event::UNDERRUN);
  event.frame = frame;
  event.index = frames;
  return event;
}

TEST(DisturbancesTest, AnUnderrunThatGoesOnCountsOnce) {
  Disturbances disturbances;
  EXPECT_EQ(disturbances.ofLastMinute(kSecondNs), "");
  EXPECT_TRUE(disturbances.isFirst(underrun(0, 10)));
  EXPECT_FALSE(disturbances.isFirst(underrun(10, 256))) << "goes on";
  EXPECT_FALSE(disturbances.isFirst(underrun(266, 256))) << "goes on";
  EXPECT_FALSE(disturbances.isFirst(underrun(1000, 1)));
  EXPECT_EQ(disturbances.ofLastMinute(61 * kSecondNs),
            "in the last minute: 1 underruns of the sound");
}

TEST(DisturbancesTest, AnUnderrunThatNeverEndsIsToldEveryMinuteWithWhatHelps) {
  Disturbances disturbances;
  EXPECT_EQ(disturbances.ofLastMinute(kSecondNs), "");
  std::int64_t frame = 0;
  const auto minute = [&](std::int64_t end_ns) {
    for (int n = 0; n < 3; ++n) {
      disturbances.isFirst(underrun(frame, 256));
      frame += 256;
    }
    return disturbances.ofLastMinute(end_ns);
  };
  EXPECT_EQ(minute(61 * kSecondNs), "") << "as it is the first, it is told at once";
  EXPECT_THAT(minute(121 * kSecondNs), ::testing::HasSubstr("1 underruns of the sound; close"));
  EXPECT_THAT(minute(181 * kSecondNs), ::testing::HasSubstr("1 underruns of the sound; close"));
  EXPECT_EQ(disturbances.ofLastMinute(241 * kSecondNs), "") << "it is over";
}

TEST(DisturbancesTest, SayWhatHelpsWhereTheSoundIsOftenInterrupted) {
  Disturbances disturbances;
  EXPECT_EQ(disturbances.ofLastMinute(kSecondNs), "");
  for (int n = 0; n < 12; ++n) {
    disturbances.isFirst(underrun(1000 * n, 1));
  }
  EXPECT_THAT(disturbances.ofLastMinute(61 * kSecondNs),
              ::testing::HasSubstr("11 underruns of the sound; close other"));
}

}  // namespace
}  // namespace ergotic::node
