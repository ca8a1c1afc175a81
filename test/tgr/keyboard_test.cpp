// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/keyboard.hpp"

#include <array>
#include <cmath>

#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

PlayMap read(const std::string& text) {
  return readPlayMap(text, "map.yaml");
}

PlayMap twoKeys() {
  return read(
      "keys:\n"
      "  - {notes: [40, 59], slices: [0, 2], to: 20 mm, speed: [0.1, 1], back: 0.5}\n"
      "  - {notes: [60, 127], end_effector: mallet, coordinates: 2, from: 0.01, to: -0.01,\n"
      "     speed: 0.2, strikes: true}\n"
      "controllers:\n"
      "  - {controller: 7, parameter: volume}\n");
}

class KeyboardTest : public ::testing::Test {
 protected:
  KeyboardTest() { keyboard_.use(twoKeys(), 0.0); }
  Keyboard::Played send(std::uint8_t status, std::uint8_t first, std::uint8_t second) {
    const std::array<std::uint8_t, 3> bytes{status, first, second};
    return keyboard_.play(bytes.data(), 3, now_s_);
  }
  Strokes note(int note, int velocity) { return keyboard_.note(note, velocity, now_s_); }
  Keyboard keyboard_;
  double now_s_ = 0.0;
};

TEST_F(KeyboardTest, TheGreatestSpeedOfAStrokeFollowsTheVelocity) {
  for (const int velocity : {1, 64, 127}) {
    const auto strokes = note(40, velocity);
    ASSERT_EQ(strokes.size(), 1U);
    EXPECT_EQ(strokes[0].index, 0);
    EXPECT_EQ(strokes[0].target_m, 0.02);
    EXPECT_NEAR(1.875 * 0.02 / strokes[0].glide_s, 0.1 * std::pow(10.0, (velocity - 1) / 126.0),
                1e-12);
    note(40, 0);
  }
}

TEST_F(KeyboardTest, NotesGoRoundTheSlicesOfTheirLine) {
  EXPECT_EQ(note(41, 100)[0].index, 2);
  EXPECT_EQ(note(42, 100)[0].index, 0);
  EXPECT_TRUE(note(39, 100).empty()) << "no line has it";
}

TEST_F(KeyboardTest, KnowsTheNoteThatMovesAHand) {
  EXPECT_EQ(keyboard_.noteOf({"", 2}), 41);
  EXPECT_EQ(keyboard_.noteOf({"mallet", 2}), 60);
  EXPECT_EQ(keyboard_.noteOf({"", 1}), std::nullopt);
  PlayMap higher = twoKeys();
  higher.transpose = 12;
  keyboard_.use(higher, 0.0);
  EXPECT_EQ(keyboard_.noteOf({"", 0}), 28) << "which sounds as 40";
}

TEST_F(KeyboardTest, AKeyGoesBackWhenItIsReleased) {
  note(40, 100);
  const auto back = note(40, 0);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].target_m, 0.0);
  EXPECT_NEAR(back[0].glide_s, 1.875 * 0.02 / 0.5, 1e-12);
  EXPECT_TRUE(note(40, 0).empty()) << "it is up already";
}

TEST_F(KeyboardTest, AStrikeGoesThereAndBackByItself) {
  const auto strokes = note(60, 64);
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_EQ(strokes[0].end_effector, "mallet");
  EXPECT_EQ(strokes[0].target_m, -0.01);
  EXPECT_EQ(strokes[1].target_m, 0.01);
  EXPECT_EQ(strokes[1].after_s, strokes[0].glide_s);
  EXPECT_TRUE(note(60, 0).empty());
}

TEST_F(KeyboardTest, AKeyThatIsDownComesUpBeforeItIsPressedAgain) {
  note(40, 100);
  const auto again = note(42, 100);  // the same slice
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[0].target_m, 0.0);
  EXPECT_EQ(again[1].target_m, 0.02);
  EXPECT_EQ(again[1].after_s, again[0].glide_s);
  EXPECT_TRUE(note(40, 0).empty()) << "the other note holds it";
  EXPECT_EQ(note(42, 0).size(), 1U);
}

TEST_F(KeyboardTest, UnderstandsMidi) {
  EXPECT_EQ(send(0x93, 40, 100).strokes.size(), 1U) << "of any channel";
  EXPECT_EQ(send(0x93, 40, 0).strokes.size(), 1U) << "velocity 0 is a release";
  send(0x90, 41, 1);
  EXPECT_EQ(send(0x80, 41, 64).strokes.size(), 1U);
  ASSERT_EQ(send(0xb0, 7, 127).changes.size(), 1U);
  EXPECT_EQ(send(0xb0, 7, 127).changes[0].parameter, "volume");
  EXPECT_EQ(send(0xb0, 7, 127).changes[0].share, 1.0);
  EXPECT_TRUE(send(0xb0, 8, 127).changes.empty());
}

TEST_F(KeyboardTest, TheSustainPedalKeepsKeysDown) {
  send(0x90, 40, 100);
  send(0xb0, 64, 127);
  EXPECT_TRUE(send(0x80, 40, 0).strokes.empty());
  const auto back = send(0xb0, 64, 0).strokes;
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].target_m, 0.0);
  EXPECT_NEAR(back[0].glide_s, 1.875 * 0.02 / 0.5, 1e-12);
  EXPECT_TRUE(send(0xb0, 64, 0).strokes.empty());
}

TEST_F(KeyboardTest, PanicReleasesEverything) {
  for (const std::uint8_t controller : std::array<std::uint8_t, 2>{120, 123}) {
    send(0xb0, 64, 127);
    send(0x90, 40, 100);
    send(0x90, 41, 100);
    send(0x80, 41, 0);
    EXPECT_EQ(send(0xb0, controller, 0).strokes.size(), 2U);
    EXPECT_TRUE(send(0xb0, controller, 0).strokes.empty());
  }
}

TEST_F(KeyboardTest, AnotherMapReleasesWhatIsDown) {
  send(0x90, 40, 100);
  EXPECT_EQ(keyboard_.use({}, now_s_).size(), 1U);
  EXPECT_TRUE(send(0x80, 40, 0).strokes.empty());
}

TEST_F(KeyboardTest, PassesOverWhatMeansNothingHere) {
  for (int status = 0; status < 256; ++status) {
    for (const int value : {0, 64, 127, 128, 255}) {
      const std::array<std::uint8_t, 3> bytes{static_cast<std::uint8_t>(status),
                                              static_cast<std::uint8_t>(value),
                                              static_cast<std::uint8_t>(value)};
      for (int size = 0; size <= 3; ++size) {
        const auto played = keyboard_.play(bytes.data(), size, now_s_);
        EXPECT_LE(played.strokes.size(), 130U);
      }
    }
  }
}

TEST(PlayMapTest, AStrokeTakesAMinuteAtMost) {
  Keyboard keyboard;
  keyboard.use(read("keys:\n  - {slices: 0, to: 1, speed: 0.001, back: 0.001, strikes: true}\n"),
               0.0);
  const auto strokes = keyboard.note(60, 1, 0.0);
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_EQ(strokes[0].glide_s, 60.0);
  EXPECT_EQ(strokes[1].after_s, 60.0);
}

TEST(PlayMapTest, Transposes) {
  PlayMap map = twoKeys();
  map.transpose = -12;
  Keyboard keyboard;
  keyboard.use(map, 0.0);
  EXPECT_EQ(keyboard.note(53, 100, 0.0)[0].index, 2);
}

TEST(PlayMapTest, TellsWhatIsWrongWhere) {
  const auto complaint = [](const std::string& text) {
    return complaintOf<TextError>([&] { read(text); });
  };
  EXPECT_THAT(complaint("keys: 3\n"), HasSubstr("map.yaml:1:"));
  EXPECT_THAT(complaint("keys:\n  - {slices: 0}\n"), HasSubstr("'to'"));
  EXPECT_THAT(complaint("keys:\n  - {slices: 64, to: 0.01}\n"), HasSubstr("map.yaml:2:"));
  EXPECT_THAT(complaint("keys:\n  - {slices: 0, to: 3}\n"), HasSubstr("-1...1"));
  EXPECT_THAT(complaint("keys:\n  - {slices: 0, to: 0.1, notes: [70, 60]}\n"),
              HasSubstr("allowed: 70 or more"));
  EXPECT_THAT(complaint("keys:\n  - {slices: 0, to: 0.1, sped: 1}\n"), HasSubstr("sped"));
  EXPECT_THAT(complaint("controllers:\n  - {controller: 128, parameter: volume}\n"),
              HasSubstr("0...127"));
}

TEST(PlayMapTest, AnEmptyTextIsAMapWithoutNotes) {
  EXPECT_TRUE(read("").keys.empty());
}

}  // namespace
}  // namespace ergotic::tgr
