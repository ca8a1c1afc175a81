// SPDX-License-Identifier: BSD-3-Clause
// Notes that move several hands, and hands that need not come up between two notes.
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "ergotic/tgr/keyboard.hpp"
#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

/// A bowed string: slice 0 draws the bow, 1 presses it, 2 is the finger, 3 its place.
const char kViolin[] =
    "keys:\n"
    "  - notes: [60, 62]\n"
    "    slices: 0\n"
    "    from: -20 mm\n"
    "    to: 20 mm\n"
    "    speed: [0.05, 0.1]\n"
    "    back: 0.05\n"
    "    release: stays\n"
    "    legato: turns\n"
    "    after: 30 ms\n"
    "    with:\n"
    "      - {slices: 1, to: 3 mm, speed: 0.1, back: 0.1, pressure_to: 4 mm}\n"
    "      - {slices: 2, to: -18 mm, speed: 0.5, back: 0.2, legato: glides}\n"
    "      - {slices: 3, to: [1 mm, 4 mm, 6 mm], speed: 1, release: stays}\n";

class HandsTest : public ::testing::Test {
 protected:
  void use(const std::string& text) { keyboard_.use(readPlayMap(text, "map.yaml"), now_s_); }
  /// The strokes of a note, the last of each slice.
  std::map<int, Stroke> play(int note, int velocity) {
    std::map<int, Stroke> last;
    for (const Stroke& stroke : keyboard_.note(note, velocity, now_s_)) {
      last[stroke.index] = stroke;
    }
    return last;
  }
  Keyboard keyboard_;
  double now_s_ = 1.0;
};

TEST_F(HandsTest, ANoteMovesAllHandsOfItsLine) {
  use(kViolin);
  const auto begun = play(61, 127);
  ASSERT_EQ(begun.size(), 4U);
  EXPECT_EQ(begun.at(0).target_m, 0.02);
  EXPECT_NEAR(begun.at(0).after_s, 0.03 + 0.02 / 0.1, 1e-12) << "evenly, from where hands rest";
  EXPECT_EQ(begun.at(0).glide_s, 0.0);
  EXPECT_EQ(begun.at(1).target_m, 0.003);
  EXPECT_EQ(begun.at(2).target_m, -0.018);
  EXPECT_EQ(begun.at(3).target_m, 0.004);
  EXPECT_NEAR(begun.at(3).glide_s, 1.875 * 0.004 / 1.0, 1e-12);
  now_s_ += 2.0;
  const auto ended = play(61, 0);
  ASSERT_EQ(ended.size(), 2U) << "bow and place stay";
  EXPECT_EQ(ended.at(1).target_m, 0.0);
  EXPECT_EQ(ended.at(2).target_m, 0.0);
}

TEST_F(HandsTest, InALegatoTheFingerStaysDownAndThePlaceGlides) {
  use(kViolin);
  play(60, 127);
  now_s_ += 2.0;
  const auto next = play(62, 127);
  EXPECT_EQ(next.count(2), 0U) << "the finger is down";
  EXPECT_EQ(next.at(3).target_m, 0.006);
  EXPECT_NEAR(next.at(3).glide_s, 1.875 * 0.005 / 1.0, 1e-12) << "from 1 mm";
  EXPECT_EQ(next.at(0).target_m, -0.02) << "the bow is at its end and turns";
  now_s_ += 0.1;
  const auto back = play(62, 0);
  EXPECT_EQ(back.at(3).target_m, 0.001) << "the note before is still held";
  EXPECT_EQ(back.count(1), 0U);
  EXPECT_EQ(back.count(2), 0U);
}

TEST_F(HandsTest, ANoteThatBeginsAsTheLastOneEndsKeepsTheFingerDown) {
  use(kViolin);
  play(60, 127);
  now_s_ += 1.0;
  EXPECT_EQ(play(60, 0).at(2).target_m, 0.0);
  const Stroke finger = play(61, 127).at(2);
  EXPECT_EQ(finger.target_m, -0.018) << "it was to go up from there";
  EXPECT_EQ(finger.glide_s, 0.0);
  EXPECT_EQ(finger.after_s, 0.0);
}

TEST_F(HandsTest, ABowGoesOnToItsFartherEndAndThenTurns) {
  use(kViolin);
  play(60, 127);
  now_s_ += 2.0;
  EXPECT_EQ(play(61, 127).at(0).target_m, -0.02);
  now_s_ += 0.1;
  EXPECT_EQ(play(62, 127).count(0), 0U) << "more than half of it is left";
  now_s_ += 0.2;
  const Stroke turned = play(60, 127).at(0);
  EXPECT_EQ(turned.target_m, 0.02);
  const double left = 0.04 - 0.1 * (0.3 - 0.03 + 0.03);  // where it is when it turns
  EXPECT_NEAR(turned.after_s, 0.03 + (0.04 - left) / 0.1, 1e-9) << "at its speed";
}

TEST_F(HandsTest, ABowThatIsLiftedBeginsAnewTowardsItsFartherEnd) {
  use(kViolin);
  play(60, 127);
  now_s_ += 0.13;
  EXPECT_EQ(play(60, 0).count(0), 0U) << "it stays on its way to the end";
  now_s_ += 0.01;
  const auto again = play(60, 1);
  ASSERT_EQ(again.count(0), 1U) << "with the velocity of its own";
  EXPECT_EQ(again.at(0).target_m, -0.02);
  EXPECT_NEAR(again.at(0).after_s, 0.03 + (0.02 + 0.014) / 0.05, 1e-9);
}

TEST_F(HandsTest, PressureMovesTheHandsThatHaveAPlaceForIt) {
  use(kViolin);
  play(60, 100);
  now_s_ += 2.0;
  const std::array<std::uint8_t, 2> pressed{0xd0, 127};
  std::map<int, double> ends;
  for (const Stroke& stroke : keyboard_.play(pressed.data(), 2, now_s_).strokes) {
    ends[stroke.index] = stroke.target_m;
  }
  EXPECT_EQ(ends, (std::map<int, double>{{1, 0.004}}));
}

TEST_F(HandsTest, AHandThatStaysFollowsNoHalfPedal) {
  use(kViolin);
  play(61, 100);
  now_s_ += 2.0;
  const std::array<std::uint8_t, 3> pedal{0xb0, 64, 64};
  keyboard_.play(pedal.data(), 3, now_s_);
  for (const Stroke& stroke : keyboard_.note(61, 0, now_s_)) {
    EXPECT_TRUE(stroke.index == 1 || stroke.index == 2) << stroke.index;
  }
}

TEST_F(HandsTest, AHandThatStrikesBesidesComesBackAtOnce) {
  use("keys:\n"
      "  - slices: 0\n"
      "    to: 20 mm\n"
      "    release: stays\n"
      "    legato: turns\n"
      "    with: [{slices: 1, to: 5 mm, strikes: true, after: 10 ms}]\n");
  const Strokes strokes = keyboard_.note(60, 100, now_s_);
  ASSERT_EQ(strokes.size(), 4U) << "a line has two";
  EXPECT_EQ(strokes[2].after_s, 0.01);
  EXPECT_EQ(strokes[3].target_m, 0.0);
  EXPECT_EQ(strokes[3].after_s, 0.01 + strokes[2].glide_s);
  EXPECT_TRUE(keyboard_.note(60, 0, now_s_ + 1.0).empty());
}

TEST_F(HandsTest, APlectrumPlucksOnItsWayBackWithTheNextNote) {
  use("keys:\n  - {slices: 0, to: 26 mm, release: stays, legato: turns}\n");
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(play(60, 100).at(0).target_m, i % 2 == 0 ? 0.026 : 0.0);
    EXPECT_TRUE(play(60, 0).empty());
    now_s_ += 1.0;
  }
}

TEST_F(HandsTest, ACrankStopsWhereItIsAndGoesOnWithTheNextNote) {
  use("keys:\n"
      "  - {slices: 0, from: -28 mm, to: 28 mm, speed: 0.036, release: stops, legato: turns}\n");
  play(60, 100);
  now_s_ += 0.25;
  const double there = 0.036 * 0.25;
  const Strokes stopped = keyboard_.note(60, 0, now_s_);
  ASSERT_EQ(stopped.size(), 2U);
  EXPECT_NEAR(stopped[0].target_m, there, 1e-12);
  EXPECT_NEAR(stopped[1].target_m, there + 0.036 * 0.01, 1e-12);
  EXPECT_EQ(stopped[1].after_s, 0.02);
  now_s_ += 10.0;
  EXPECT_TRUE(keyboard_.note(60, 0, now_s_).empty());
  const Stroke on = play(62, 100).at(0);
  EXPECT_EQ(on.target_m, -0.028);
  EXPECT_NEAR(on.after_s, (0.028 + stopped[1].target_m) / 0.036, 1e-9);
  now_s_ += 0.1;
  EXPECT_EQ(play(64, 100).count(0), 0U) << "it goes on for the next note";
  EXPECT_EQ(play(64, 0).count(0), 0U) << "and when that ends, for the one before";
}

TEST_F(HandsTest, ANoteThatEndsBeforeAHandHasBegunTakesItBack) {
  use("keys:\n  - {slices: 0, to: 10 mm, after: 0.5}\n");
  play(60, 100);
  now_s_ += 0.1;
  const auto ended = play(60, 0);
  EXPECT_EQ(ended.at(0).target_m, 0.0);
  EXPECT_LT(ended.at(0).after_s, 0.4) << "a hand drops what it was to do later";
}

TEST_F(HandsTest, AnotherMapLetsGoOfHandsThatStay) {
  use(kViolin);
  play(60, 100);
  std::map<int, bool> let_go;
  for (const Stroke& stroke : keyboard_.use({}, now_s_ + 1.0)) {
    let_go[stroke.index] = stroke.lets_go;
  }
  EXPECT_EQ(let_go, (std::map<int, bool>{{0, true}, {1, false}, {2, false}, {3, true}}));
}

TEST_F(HandsTest, TheNoteOfAHandIsOneThatBeginsWithIt) {
  use(std::string(kViolin) + "  - {notes: [70, 80], slices: 2, to: -18 mm}\n");
  EXPECT_EQ(keyboard_.noteOf({"", 0}), 60);
  EXPECT_EQ(keyboard_.noteOf({"", 2}), 70);
  EXPECT_EQ(keyboard_.noteOf({"", 3}), 60);
  EXPECT_EQ(keyboard_.noteOf({"", 4}), std::nullopt);
}

TEST_F(HandsTest, TellsWhatIsWrongWithAHand) {
  const auto complaint = [](const std::string& rest) {
    return complaintOf<TextError>([&] {
      readPlayMap("keys:\n  - {notes: [60, 62], slices: 0, " + rest + "}\n", "map.yaml");
    });
  };
  EXPECT_THAT(complaint("to: [1 mm, 2 mm]"), HasSubstr("2 places, allowed: 1, or 3"));
  EXPECT_THAT(complaint("to: 1 mm, strikes: true, release: stays"), HasSubstr("'release'"));
  EXPECT_THAT(complaint("to: 1 mm, strikes: true, legato: turns"), HasSubstr("'legato'"));
  EXPECT_THAT(complaint("to: 1 mm, legato: slides"), HasSubstr("'glides'"));
  EXPECT_THAT(complaint("to: 1 mm, legato: turns, pressure_to: 2 mm"), HasSubstr("beside turns"));
  EXPECT_THAT(complaint("to: 1 mm, after: 2"), HasSubstr("0...1"));
  EXPECT_THAT(complaint("to: 1 mm, with: {slices: 1, to: 1 mm}"), HasSubstr("a list of maps"));
  EXPECT_THAT(complaint("to: 1 mm, with: [{slices: 1, to: 1 mm, notes: 60}]"), HasSubstr("notes"));
  EXPECT_THAT(complaint("to: 1 mm, with: [{to: 1 mm}]"), HasSubstr("entry 1 of 'with'"));
}

}  // namespace
}  // namespace ergotic::tgr
