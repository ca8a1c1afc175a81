// SPDX-License-Identifier: BSD-3-Clause
// Notes that move several hands, and hands that need not come up between two notes.
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "ergotic/tgr/driver.hpp"
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
      told_m_[stroke.index] = stroke.target_m;
    }
    return last;
  }
  Keyboard keyboard_;
  std::map<int, double> told_m_;  // where each slice was sent last
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
  EXPECT_EQ(next.at(2).target_m, -0.018) << "the finger is down, and stays there";
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
  EXPECT_EQ(finger.after_s, 0.0);
}

TEST_F(HandsTest, ABowTurnsWithANoteThatBeginsBeyondItsMiddle) {
  use(kViolin);
  play(60, 127);
  now_s_ += 2.0;
  EXPECT_EQ(play(61, 127).at(0).target_m, -0.02);
  now_s_ += 0.1;
  const Stroke on = play(62, 1).at(0);
  EXPECT_EQ(on.target_m, -0.02) << "more than half of it is left";
  EXPECT_NEAR(on.after_s, 0.03 + 0.03 / 0.05, 1e-9) << "from 10 mm, at the speed of its own note";
  now_s_ += 0.6;
  EXPECT_EQ(play(60, 127).at(0).target_m, 0.02);
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
  ASSERT_EQ(strokes.size(), 3U);
  EXPECT_EQ(strokes[1].after_s, 0.01);
  EXPECT_EQ(strokes[2].target_m, 0.0);
  EXPECT_EQ(strokes[2].after_s, 0.01 + strokes[1].glide_s);
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

TEST_F(HandsTest, ACrankTurnsAtItsEndsStopsWhereItIsAndGoesOnWithTheNextNote) {
  use("keys:\n"
      "  - {slices: 0, from: -28 mm, to: 28 mm, speed: 0.028, release: stops, legato: turns}\n");
  const Strokes begun = keyboard_.note(60, 100, now_s_);
  ASSERT_EQ(begun.size(), 17U) << "there, and sixteen times to the other end";
  EXPECT_EQ(begun[0].target_m, 0.028);
  EXPECT_NEAR(begun[0].after_s, 1.0, 1e-12);
  EXPECT_EQ(begun[1].target_m, -0.028);
  EXPECT_NEAR(begun[1].after_s, 3.0, 1e-12);
  now_s_ += 3.5;  // a quarter of its third way
  const Strokes stopped = keyboard_.note(60, 0, now_s_);
  ASSERT_EQ(stopped.size(), 2U);
  EXPECT_NEAR(stopped[0].target_m, -0.014, 1e-12);
  EXPECT_NEAR(stopped[1].target_m, -0.014 + 0.028 * 0.01, 1e-12);
  EXPECT_EQ(stopped[1].after_s, 0.02);
  now_s_ += 10.0;
  EXPECT_TRUE(keyboard_.note(60, 0, now_s_).empty());
  const Strokes on = keyboard_.note(62, 100, now_s_);
  EXPECT_EQ(on[0].target_m, 0.028);
  EXPECT_NEAR(on[0].after_s, (0.028 - stopped[1].target_m) / 0.028, 1e-9);
  now_s_ += 0.1;
  play(64, 100);
  EXPECT_TRUE(play(64, 0).empty()) << "it goes on for the note before";
  EXPECT_EQ(play(62, 0).size(), 1U);
}

TEST_F(HandsTest, ASlowCrankTurnsOnlyAsOftenAsADeviceCanWait) {
  use("keys:\n  - {slices: 0, from: -28 mm, to: 28 mm, speed: 0.002, release: stops, legato: "
      "turns}\n");
  const Strokes strokes = keyboard_.note(60, 100, now_s_);
  ASSERT_EQ(strokes.size(), 4U) << "14 s, and three times 28";
  for (const Stroke& stroke : strokes) {
    HandMove move;
    move.target_m = stroke.target_m;
    move.delay_s = stroke.after_s;
    EXPECT_TRUE(move.isValid(1)) << stroke.after_s;
  }
  now_s_ += 110.0;
  EXPECT_TRUE(keyboard_.note(60, 0, now_s_).empty()) << "it has ended";
}

TEST_F(HandsTest, AHandThatStrikesBesideOthersHangsNowhere) {
  use("keys:\n"
      "  - {notes: [57, 57], slices: 0, to: 26 mm, release: stays, legato: turns,\n"
      "     with: [{slices: 1, to: 7 mm, strikes: true}]}\n"
      "  - {notes: [58, 58], slices: 1, to: 6 mm}\n");
  for (const auto& [first, second] : {std::pair(57, 58), std::pair(58, 57)}) {
    play(first, 100);
    play(second, 100);
    now_s_ += 1.0;
    play(58, 0);
    play(57, 0);
    EXPECT_EQ(told_m_[1], 0.0) << first << " first";
    now_s_ += 1.0;
  }
}

TEST_F(HandsTest, AWheelKeepsTheHandThatANoteHasPut) {
  use("keys:\n"
      "  - {notes: [60, 62], slices: 0, to: 10 mm, pressure_to: 12 mm,\n"
      "     with: [{slices: 1, to: [1 mm, 4 mm, 6 mm], release: stays}]}\n"
      "controllers:\n"
      "  - {controller: 1, slices: 1, to: 8 mm}\n");
  const auto send = [&](std::uint8_t status, std::uint8_t first, std::uint8_t second) {
    const std::array<std::uint8_t, 3> bytes{status, first, second};
    now_s_ += 1.0;
    return keyboard_.play(bytes.data(), 3, now_s_).strokes;
  };
  send(0x90, 60, 100);
  send(0x90, 61, 100);
  send(0xb0, 1, 127);
  for (const Stroke& stroke : send(0xa0, 61, 100)) {
    EXPECT_EQ(stroke.index, 0) << "pressed";
  }
  for (const Stroke& stroke : send(0x80, 60, 0)) {
    EXPECT_EQ(stroke.index, 0) << "the older note ends";
  }
  send(0xb0, 64, 127);
  send(0x80, 61, 0);
  EXPECT_TRUE(send(0xb0, 64, 120).empty()) << "a pedal that stays down";
}

TEST_F(HandsTest, TheBendGoesFromWhereANoteHasPutAHand) {
  use("keys:\n"
      "  - {notes: [60, 62], slices: 0, to: 10 mm,\n"
      "     with: [{slices: 1, to: [0 mm, 12 mm, 20 mm], release: stays}]}\n"
      "controllers:\n"
      "  - {bend: true, slices: 1, from: -5 mm, to: 5 mm}\n");
  const auto bent = [&](std::uint8_t low, std::uint8_t high) {
    const std::array<std::uint8_t, 3> bytes{0xe0, low, high};
    now_s_ += 1.0;
    const Strokes strokes = keyboard_.play(bytes.data(), 3, now_s_).strokes;
    return strokes.empty() ? std::nan("") : strokes.back().target_m;
  };
  EXPECT_EQ(bent(127, 127), 0.005) << "no note has put it anywhere";
  play(61, 100);
  EXPECT_NEAR(bent(127, 127), 0.017, 1e-12);
  EXPECT_NEAR(bent(0, 64), 0.012, 1e-12);
  play(62, 100);
  EXPECT_NEAR(bent(0, 0), 0.015, 1e-12);
  EXPECT_NEAR(bent(127, 127), 0.020, 1e-12) << "no farther than notes put it";
}

TEST_F(HandsTest, AShortNoteWithinAnotherLeavesNothingBehind) {
  use("keys:\n"
      "  - {notes: [60, 61], slices: 0, to: [5 mm, 9 mm], after: 0.2, legato: glides}\n");
  play(60, 100);
  now_s_ += 1.0;
  play(61, 100);
  now_s_ += 0.05;
  const auto ended = play(61, 0);
  EXPECT_EQ(ended.at(0).target_m, 0.005);
  EXPECT_EQ(ended.at(0).after_s, 0.0) << "it never goes to 9 mm";
}

TEST_F(HandsTest, OfKeysThatAPedalKeptTheLastSaysWhatBecomesOfItsHand) {
  use("keys:\n"
      "  - {notes: [40, 40], slices: 0, to: 8 mm}\n"
      "  - {notes: [50, 50], slices: 0, to: 12 mm, release: stays}\n");
  const auto pedal = [&](std::uint8_t value) {
    const std::array<std::uint8_t, 3> bytes{0xb0, 64, value};
    return keyboard_.play(bytes.data(), 3, now_s_).strokes;
  };
  pedal(127);
  for (const int note : {40, 50}) {
    play(note, 100);
    play(note, 0);
  }
  now_s_ += 1.0;
  EXPECT_TRUE(pedal(0).empty()) << "it stays";
}

TEST_F(HandsTest, ANoteThatEndsBeforeAHandHasBegunTakesItBack) {
  use("keys:\n  - {slices: 0, to: 10 mm, after: 0.5}\n");
  play(60, 100);
  now_s_ += 0.1;
  const auto ended = play(60, 0);
  EXPECT_EQ(ended.at(0).target_m, 0.0);
  EXPECT_LT(ended.at(0).after_s, 0.4) << "a hand drops what it was to do later";
}

TEST_F(HandsTest, AFingerStaysUntilThePlectrumHasPluckedHoweverShortTheNote) {
  use("keys:\n"
      "  - {notes: [60, 60], slices: 0, to: 26 mm, speed: 1, release: stays, legato: turns, after: "
      "50 ms,\n"
      "     with: [{slices: 1, to: -14 mm, speed: 1, back: 0.5, after: 20 ms, legato: glides}]}\n"
      "  - {notes: [62, 62], slices: 2, to: 10 mm, speed: 1, back: 0.5, after: 20 ms}\n");
  play(60, 127);
  now_s_ += 0.01;
  EXPECT_NEAR(play(60, 0).at(1).after_s, 0.05 + 0.026 - 0.01, 1e-9);
  play(62, 127);
  now_s_ += 0.01;
  EXPECT_EQ(play(62, 0).at(2).after_s, 0.0) << "a hand by itself comes back at once";
  now_s_ += 1.0;
  play(60, 127);
  now_s_ += 0.5;
  EXPECT_EQ(play(60, 0).at(1).after_s, 0.0);
  now_s_ += 1.0;
  const auto pedal = [&](std::uint8_t value) {
    const std::array<std::uint8_t, 3> bytes{0xb0, 64, value};
    return keyboard_.play(bytes.data(), 3, now_s_).strokes;
  };
  pedal(127);
  play(60, 127);
  play(60, 0);
  now_s_ += 0.01;
  EXPECT_NEAR(pedal(0).back().after_s, 0.05 + 0.026 - 0.01, 1e-9) << "a pedal that comes up";
}

TEST_F(HandsTest, ASlowBowKeepsAShortNoteForAQuarterOfASecondAtMost) {
  use(kViolin);
  play(60, 1);
  now_s_ += 0.05;
  EXPECT_NEAR(play(60, 0).at(1).after_s, 0.2, 1e-9);
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
  use("keys:\n  - {notes: [60, 127], slices: 0, to: 8 mm}\n" + std::string(kViolin).substr(6));
  EXPECT_EQ(keyboard_.noteOf({"", 0}), 60) << "of the first line";
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
  EXPECT_THAT(complaint("to: 1 mm, with: [{slices: [1, 0], to: 1 mm}]"), HasSubstr("already"));
  EXPECT_THAT(complaint("to: 1 mm, with: [{to: 1 mm}]"), HasSubstr("entry 1 of 'with'"));
}

}  // namespace
}  // namespace ergotic::tgr
