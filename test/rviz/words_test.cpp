// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/words.hpp"

#include <set>

#include "rviz/caller.hpp"
#include "rviz/message_log.hpp"
#include "support/test.hpp"

namespace ergotic::panel {
namespace {

constexpr Lamp kAll[] = {Lamp::kStale,    Lamp::kDisconnected, Lamp::kUncalibrated, Lamp::kReady,
                         Lamp::kEngaging, Lamp::kPlaying,      Lamp::kFault};

std::string reason(Lamp lamp, const Status& status) {
  return reasonOf(lamp, status, 0.5, "/station", true);
}

TEST(WordsTest, EveryStateHasALampOfItsOwn) {
  std::set<Lamp> lamps;
  for (std::uint8_t state = Status::DISCONNECTED; state <= Status::FAULT; ++state) {
    lamps.insert(lampOf(state, 0.5));
  }
  EXPECT_EQ(lamps.size(), 6U);
  EXPECT_EQ(lamps.count(Lamp::kStale), 0U);
  EXPECT_EQ(lampOf(Status::PLAYING, 0.0), Lamp::kPlaying);
  EXPECT_EQ(lampOf(200, 0.0), Lamp::kDisconnected);
}

TEST(WordsTest, NoLampTellsOfForceWhenTheStationIsSilent) {
  for (std::uint8_t state = Status::DISCONNECTED; state <= Status::FAULT; ++state) {
    EXPECT_EQ(lampOf(state, 3.1), Lamp::kStale);
    EXPECT_EQ(lampOf(state, -1.0), Lamp::kStale);
  }
  EXPECT_EQ(lampOf(Status::PLAYING, 2.9), Lamp::kPlaying);
}

TEST(WordsTest, WordsDifferAndReasonsAreSentences) {
  std::set<std::string> words;
  Status status;
  status.state_text = "fault: emergency stop";
  status.uncalibrated = {3};
  for (const Lamp lamp : kAll) {
    words.insert(wordOf(lamp));
    EXPECT_EQ(reason(lamp, status).back(), '.') << wordOf(lamp);
  }
  EXPECT_EQ(words.size(), std::size(kAll));
}

TEST(WordsTest, ReasonsSayWhatTheStationSaid) {
  Status status;
  status.state_text = "fault: emergency stop";
  EXPECT_EQ(reason(Lamp::kFault, status), "Emergency stop. Recover ends it, then Engage.");
  status.message = "no board /dev/comedi0\nand more";
  EXPECT_EQ(reason(Lamp::kDisconnected, status), "No board /dev/comedi0.");
  status.message = "drum.yaml:3:1: error: scene 'drum' is too heavy";
  EXPECT_EQ(reason(Lamp::kDisconnected, status), "Scene 'drum' is too heavy.");
  status.uncalibrated = {1, 4};
  EXPECT_EQ(reason(Lamp::kUncalibrated, status), "Slices 1, 4 have no calibration.");
}

TEST(WordsTest, SilenceIsToldByItsCause) {
  const Status none;
  EXPECT_EQ(reasonOf(Lamp::kStale, none, 7.2, "/left", true), "/left said nothing for 7 s.");
  EXPECT_EQ(reasonOf(Lamp::kStale, none, -1.0, "/left", true), "No station /left was heard yet.");
  EXPECT_EQ(reasonOf(Lamp::kStale, none, 7.2, "/left", false), "The ROS master does not answer.");
}

TEST(WordsTest, RatesAreToldAsFarAsTheyAreKnown) {
  Status status;
  EXPECT_EQ(ratesText(status), "");
  status.gestural_rate = 3150.0;
  status.audio_rate = 44100.0;
  EXPECT_EQ(ratesText(status), "3150 ticks/s, sound 44.1 kHz");
  status.delay_ticks = 1.0;
  EXPECT_EQ(ratesText(status), "3150 ticks/s, force after 0.32 ms, sound 44.1 kHz");
}

TEST(WordsTest, AnAnswerToALoadSaysTheVerdictInItsFirstLine) {
  LoadModel::Response response;
  response.message = "plays 'drum'; call engage for force\nand a warning";
  response.verdict = "bounded";
  EXPECT_EQ(wordsOf(response),
            "plays 'drum'; call engage for force (certificate: bounded)\nand a warning");
}

TEST(MessageLogTest, KeepsTheLastHundredLinesNewestLast) {
  MessageLog log;
  for (int i = 0; i < 250; ++i) {
    log.add("12:00:00", "line " + std::to_string(i));
  }
  const std::string text = log.text();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 99);
  EXPECT_EQ(text.rfind("12:00:00 line 150\n", 0), 0U);
  EXPECT_EQ(text.substr(text.size() - 17), "12:00:00 line 249");
}

TEST(MessageLogTest, WhatComesAgainAndAgainIsOneLine) {
  MessageLog log;
  for (int i = 0; i < 5000; ++i) {
    log.add("12:00:00", "tick " + std::to_string(i) + " ms late", "late");
  }
  EXPECT_EQ(log.text(), "12:00:00 tick 4999 ms late (5000 times)");
  log.add("12:00:01", "stall", "stall");
  log.add("12:00:01", "tick 7 ms late", "late");
  EXPECT_EQ(log.text(), "12:00:01 stall\n12:00:01 tick 7 ms late (5001 times)");
  log.add("12:00:01", "full force");
  log.add("12:00:02", "tick 1 ms late", "late");
  EXPECT_EQ(log.text(),
            "12:00:01 stall\n12:00:01 tick 7 ms late (5001 times)\n12:00:01 full force\n12:00:02 "
            "tick 1 ms late");
}

TEST(MessageLogTest, EveryChangeIsAnotherVersion) {
  MessageLog log;
  const std::size_t empty = log.version();
  log.add("", "a", "kind");
  const std::size_t one = log.version();
  log.add("", "a", "kind");
  EXPECT_NE(empty, one);
  EXPECT_NE(one, log.version());
}

TEST(WordsTest, OnlyDisturbancesAreSummedUp) {
  Event event;
  for (std::uint8_t type = Event::ENGAGED; type <= Event::INJECTED; ++type) {
    event.type = type;
    const bool sums = type >= Event::LATE_TICK && type <= Event::AUDIO_SKIPPED;
    EXPECT_EQ(!kindOf(event).empty(), sums) << int{type};
  }
  event.type = Event::FAULT;
  EXPECT_TRUE(isWorthALine(event));
  event.type = Event::KEYFRAME;
  EXPECT_FALSE(isWorthALine(event));
}

TEST(WordsTest, NamesOfTakesAndPresetsHaveNoBlanks) {
  EXPECT_EQ(nameText("my first roll"), "my_first_roll");
  EXPECT_EQ(nameText("  hard mallets "), "hard_mallets");
  EXPECT_EQ(nameText("soft"), "soft");
  EXPECT_EQ(nameText("   "), "");
}

}  // namespace
}  // namespace ergotic::panel
