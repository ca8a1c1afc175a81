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

}  // namespace
}  // namespace ergotic::node
