// SPDX-License-Identifier: BSD-3-Clause
// Buttons, sticks and triggers of gamepads.
#include <map>

#include "ergotic/tgr/keyboard.hpp"
#include "support/test.hpp"

namespace ergotic::tgr {
namespace {

GamepadMove button(GamepadButton which, bool is_down) {
  return {true, static_cast<int>(which), is_down ? 1.0 : 0.0};
}

GamepadMove axis(GamepadAxis which, double value) {
  return {false, static_cast<int>(which), value};
}

class GamepadTest : public ::testing::Test {
 protected:
  void use(const std::string& text) { keyboard_.use(readPlayMap(text, "map.yaml"), now_s_); }
  Keyboard::Played send(const GamepadMove& move, int pad = 0) {
    now_s_ += 1.0;
    return keyboard_.play(move, pad, now_s_);
  }
  Strokes press(GamepadButton which, int pad = 0) { return send(button(which, true), pad).strokes; }
  Strokes release(GamepadButton which, int pad = 0) {
    return send(button(which, false), pad).strokes;
  }
  Strokes unplug(int pad = 0) {
    now_s_ += 1.0;
    return keyboard_.unplug(pad, now_s_);
  }
  /// Where the last stroke of each hand ends; not a number where it lets go.
  static std::map<int, double> padEnds(const Strokes& strokes) {
    std::map<int, double> ends;
    for (const Stroke& stroke : strokes) {
      ends[stroke.index] = stroke.lets_go ? -1.0 : stroke.target_m;
    }
    return ends;
  }
  Keyboard keyboard_;
  double now_s_ = 0.0;
};

using Ends = std::map<int, double>;

TEST_F(GamepadTest, ButtonsPlayNotesByTheKeysOfTheMap) {
  use("keys:\n  - {notes: [60, 71], slices: [0, 1], to: 10 mm, speed: [0.1, 1]}\n"
      "gamepad:\n"
      "  - {button: south, note: 60, velocity: 127}\n"
      "  - {button: dpad_up, note: 61, velocity: 1}\n");
  const Strokes hard = press(GamepadButton::kSouth);
  const Strokes soft = press(GamepadButton::kDpadUp);
  EXPECT_EQ(padEnds(hard), (Ends{{0, 0.01}}));
  EXPECT_EQ(padEnds(soft), (Ends{{1, 0.01}}));
  EXPECT_NEAR(hard[0].glide_s, 1.875 * 0.01 / 1.0, 1e-12);
  EXPECT_NEAR(soft[0].glide_s, 1.875 * 0.01 / 0.1, 1e-12);
  EXPECT_EQ(padEnds(release(GamepadButton::kSouth)), (Ends{{0, 0.0}}));
  EXPECT_TRUE(press(GamepadButton::kEast).empty()) << "the map says nothing of it";
}

TEST_F(GamepadTest, TheMapTransposesButtonsAsAllNotes) {
  use("keys:\n  - {notes: [60, 60], slices: 3, to: 10 mm}\n"
      "gamepad:\n  - {button: south, note: 48}\ntranspose: 12\n");
  EXPECT_EQ(padEnds(press(GamepadButton::kSouth)), (Ends{{3, 0.01}}));
}

TEST_F(GamepadTest, ANoteOfTwoButtonsIsDownAsLongAsOneOfThem) {
  use("keys:\n  - {notes: [60, 60], slices: 0, to: 10 mm}\n"
      "gamepad:\n  - {button: south, note: 60}\n  - {button: east, note: 60}\n");
  press(GamepadButton::kSouth);
  press(GamepadButton::kEast);
  EXPECT_TRUE(release(GamepadButton::kSouth).empty());
  EXPECT_EQ(padEnds(release(GamepadButton::kEast)), (Ends{{0, 0.0}}));
  press(GamepadButton::kSouth, 0);
  press(GamepadButton::kSouth, 1);
  EXPECT_TRUE(release(GamepadButton::kSouth, 0).empty()) << "the other gamepad holds it";
  EXPECT_EQ(padEnds(release(GamepadButton::kSouth, 1)), (Ends{{0, 0.0}}));
}

TEST_F(GamepadTest, AButtonMayPlaySeveralNotes) {
  use("keys:\n  - {notes: [60, 71], slices: [0, 1, 2], to: 10 mm}\n"
      "gamepad:\n  - {button: start, note: 60}\n  - {button: start, note: 62}\n");
  EXPECT_EQ(padEnds(press(GamepadButton::kStart)), (Ends{{0, 0.01}, {2, 0.01}}));
  EXPECT_EQ(padEnds(release(GamepadButton::kStart)), (Ends{{0, 0.0}, {2, 0.0}}));
}

TEST_F(GamepadTest, SticksMoveHandsAboutTheMiddleAndTriggersFromOneEnd) {
  use("gamepad:\n"
      "  - {axis: right_x, slices: [2, 3], from: -10 mm, to: 30 mm, speed: 2}\n"
      "  - {axis: left_trigger, slices: 4, from: 5 mm, to: 15 mm, speed: 0.1}\n");
  EXPECT_EQ(padEnds(send(axis(GamepadAxis::kRightX, 1.0)).strokes), (Ends{{2, 0.03}, {3, 0.03}}));
  EXPECT_EQ(padEnds(send(axis(GamepadAxis::kRightX, -1.0)).strokes),
            (Ends{{2, -0.01}, {3, -0.01}}));
  EXPECT_EQ(padEnds(send(axis(GamepadAxis::kRightX, 0.0)).strokes), (Ends{{2, 0.01}, {3, 0.01}}));
  const Strokes pulled = send(axis(GamepadAxis::kLeftTrigger, 1.0)).strokes;
  EXPECT_EQ(padEnds(pulled), (Ends{{4, 0.015}}));
  EXPECT_NEAR(pulled.back().after_s, 0.1, 1e-12) << "10 mm at 0.1 m/s";
  EXPECT_EQ(padEnds(send(axis(GamepadAxis::kLeftTrigger, 0.0)).strokes), (Ends{{4, 0.005}}));
  EXPECT_TRUE(send(axis(GamepadAxis::kLeftY, 1.0)).strokes.empty());
}

TEST_F(GamepadTest, AxesMoveParametersAboutWhatIsUsualOrOverTheirRange) {
  use("gamepad:\n"
      "  - {axis: left_x, parameter: tension}\n"
      "  - {axis: right_trigger, parameter: loss}\n");
  const ParameterRange range{100.0, 120.0, 160.0};
  const auto value = [&](GamepadAxis which, double share) {
    return valueOf(send(axis(which, share)).changes.at(0), range);
  };
  EXPECT_EQ(value(GamepadAxis::kLeftX, 0.0), 120.0);
  EXPECT_EQ(value(GamepadAxis::kLeftX, 1.0), 160.0);
  EXPECT_EQ(value(GamepadAxis::kLeftX, -1.0), 100.0);
  EXPECT_EQ(value(GamepadAxis::kRightTrigger, 0.0), 100.0);
  EXPECT_EQ(value(GamepadAxis::kRightTrigger, 0.5), 130.0);
}

TEST_F(GamepadTest, AnAxisCanBeLearnt) {
  keyboard_.learner().wait("tension");
  send(axis(GamepadAxis::kRightY, 0.0));
  const auto played = send(axis(GamepadAxis::kRightY, 0.5));
  ASSERT_TRUE(played.learnt.has_value());
  EXPECT_EQ(nameOf(played.learnt->control), "right_y of the gamepad");
  EXPECT_TRUE(played.changes.at(0).is_bent);
}

TEST_F(GamepadTest, WithoutLinesEachHandHasAButtonAndTheLeftStickMovesTwo) {
  use("keys:\n"
      "  - {notes: [40, 59], slices: [5, 2], to: 20 mm}\n"
      "  - {notes: [60, 127], slices: [2, 7], from: 1 mm, to: 6 mm, strikes: true}\n");
  EXPECT_EQ(press(GamepadButton::kSouth).at(0).index, 5);
  EXPECT_EQ(press(GamepadButton::kEast).at(0).index, 2);
  EXPECT_EQ(press(GamepadButton::kWest).at(0).index, 7);
  EXPECT_TRUE(press(GamepadButton::kNorth).empty()) << "there are three hands";
  release(GamepadButton::kSouth);
  release(GamepadButton::kEast);
  EXPECT_EQ(padEnds(send(axis(GamepadAxis::kLeftY, 1.0)).strokes), (Ends{{5, 0.02}}));
  EXPECT_EQ(padEnds(send(axis(GamepadAxis::kLeftY, -1.0)).strokes), (Ends{{5, -0.02}}));
  EXPECT_EQ(padEnds(send(axis(GamepadAxis::kLeftX, 1.0)).strokes), (Ends{{2, 0.02}}));
  EXPECT_TRUE(send(axis(GamepadAxis::kRightX, 0.5)).strokes.empty());
}

TEST_F(GamepadTest, AHandThatNoNoteMovesHasNoButton) {
  use("keys:\n"
      "  - {notes: [60, 60], slices: [0, 1], to: 20 mm}\n"
      "  - {notes: [62, 62], slices: 2, to: 20 mm}\n");
  EXPECT_EQ(press(GamepadButton::kSouth).at(0).index, 0);
  EXPECT_EQ(press(GamepadButton::kEast).at(0).index, 2);
}

TEST_F(GamepadTest, WithEmptyLinesItDoesNothing) {
  use("keys:\n  - {slices: 0, to: 20 mm}\ngamepad: []\n");
  EXPECT_TRUE(press(GamepadButton::kSouth).empty());
  EXPECT_TRUE(send(axis(GamepadAxis::kLeftY, 1.0)).strokes.empty());
}

TEST_F(GamepadTest, TheUsualStickStaysWithinReach) {
  use("keys:\n  - {slices: 0, from: 50 mm, to: -50 mm}\n");
  EXPECT_EQ(padEnds(send(axis(GamepadAxis::kLeftY, -1.0)).strokes), (Ends{{0, 0.1}}));
}

TEST_F(GamepadTest, WhoIsUnpluggedLetsGoOfEverything) {
  use("keys:\n  - {notes: [60, 71], slices: [0, 1], to: 10 mm}\n"
      "gamepad:\n"
      "  - {button: south, note: 60}\n"
      "  - {button: east, note: 61}\n"
      "  - {axis: left_x, slices: [4, 5], from: -10 mm, to: 10 mm}\n"
      "  - {axis: right_x, slices: 6, from: -10 mm, to: 10 mm}\n");
  press(GamepadButton::kSouth, 0);
  press(GamepadButton::kEast, 1);
  send(axis(GamepadAxis::kLeftX, 1.0), 0);
  send(axis(GamepadAxis::kRightX, 1.0), 1);
  EXPECT_EQ(padEnds(unplug(0)), (Ends{{0, 0.0}, {4, -1.0}, {5, -1.0}})) << "-1: let go of";
  EXPECT_TRUE(unplug(0).empty());
  EXPECT_EQ(padEnds(unplug(1)), (Ends{{1, 0.0}, {6, -1.0}}));
  EXPECT_TRUE(unplug(7).empty()) << "nobody knows it";
}

TEST_F(GamepadTest, AnotherMapReleasesButtonsAndLetsGoOfWhatAxesMoved) {
  use("keys:\n  - {notes: [60, 71], slices: 0, to: 10 mm}\n"
      "gamepad:\n"
      "  - {button: south, note: 60}\n"
      "  - {axis: left_x, slices: 4, from: -10 mm, to: 10 mm}\n");
  press(GamepadButton::kSouth);
  send(axis(GamepadAxis::kLeftX, 1.0));
  EXPECT_EQ(padEnds(keyboard_.use({}, now_s_)), (Ends{{0, 0.0}, {4, -1.0}}));
  EXPECT_TRUE(release(GamepadButton::kSouth).empty());
  EXPECT_TRUE(unplug().empty());
}

TEST_F(GamepadTest, AHandThatNoAxisHasMovedIsNotLetGoOf) {
  use("keys:\n  - {notes: [60, 71], slices: [0, 1], to: 10 mm}\n");
  keyboard_.note(60, 100, now_s_);
  keyboard_.note(61, 100, now_s_);
  send(axis(GamepadAxis::kLeftX, 0.5));  // moves the second one
  EXPECT_EQ(padEnds(keyboard_.use({}, now_s_)), (Ends{{0, 0.0}, {1, -1.0}}));
}

TEST(GamepadLinesTest, TellWhatIsWrongWhere) {
  const auto complaint = [](const std::string& line) {
    return complaintOf<TextError>([&] { readPlayMap("gamepad:\n  - " + line, "map.yaml"); });
  };
  EXPECT_THAT(complaint("{button: x, note: 60}\n"),
              AllOf(HasSubstr("map.yaml:2:14"), HasSubstr("south"), HasSubstr("start")));
  EXPECT_THAT(complaint("{button: south}\n"), HasSubstr("missing key 'note'"));
  EXPECT_THAT(complaint("{button: south, note: 128}\n"), HasSubstr("0...127"));
  EXPECT_THAT(complaint("{button: south, note: 60, velocity: 0}\n"), HasSubstr("1...127"));
  EXPECT_THAT(complaint("{button: south, note: 60, axis: left_x}\n"), HasSubstr("'axis'"));
  EXPECT_THAT(complaint("{axis: up, parameter: x}\n"), HasSubstr("right_trigger"));
  EXPECT_THAT(complaint("{axis: left_x}\n"), HasSubstr("missing key 'parameter'"));
  EXPECT_THAT(complaint("{axis: left_x, slices: 0, to: 2}\n"), HasSubstr("-1...1"));
  EXPECT_THAT(complaint("{note: 60}\n"), HasSubstr("missing key 'axis'"));
}

}  // namespace
}  // namespace ergotic::tgr
