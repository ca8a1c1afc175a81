// SPDX-License-Identifier: BSD-3-Clause
#include "gamepads/pad_decoder.hpp"

#include <linux/input-event-codes.h>

#include "gamepads/evdev_pad.hpp"
#include "gamepads/gamepad_watch.hpp"
#include "support/test.hpp"

namespace ergotic::gamepads {
namespace {

using tgr::GamepadAxis;
using tgr::GamepadButton;

constexpr PadTraits::Range kStick{-32768, 32767, 128};
constexpr PadTraits::Range kTrigger{0, 255, 0};

/// As the kernel's driver of the most usual ones has it.
PadTraits xpad() {
  return {"Xbox pad",
          {{ABS_X, kStick},
           {ABS_Y, kStick},
           {ABS_RX, kStick},
           {ABS_RY, kStick},
           {ABS_Z, kTrigger},
           {ABS_RZ, kTrigger},
           {ABS_HAT0X, {-1, 1, 0}},
           {ABS_HAT0Y, {-1, 1, 0}}}};
}

class PadDecoderTest : public ::testing::Test {
 protected:
  std::vector<tgr::GamepadMove> axisIs(int code, int value) {
    return decoder_.decode({EV_ABS, code, value});
  }
  std::vector<tgr::GamepadMove> keyIs(int code, int value) {
    return decoder_.decode({EV_KEY, code, value});
  }
  PadDecoder decoder_{xpad()};
};

void expectAxis(const std::vector<tgr::GamepadMove>& moves, GamepadAxis axis, double value) {
  ASSERT_EQ(moves.size(), 1U);
  EXPECT_FALSE(moves[0].is_button);
  EXPECT_EQ(moves[0].number, static_cast<int>(axis));
  EXPECT_NEAR(moves[0].value, value, 1e-4);
}

void expectButton(const std::vector<tgr::GamepadMove>& moves, GamepadButton button, double value) {
  ASSERT_EQ(moves.size(), 1U);
  EXPECT_TRUE(moves[0].is_button);
  EXPECT_EQ(moves[0].number, static_cast<int>(button));
  EXPECT_EQ(moves[0].value, value);
}

TEST_F(PadDecoderTest, SticksReachBothEndsAndForwardIsPositive) {
  expectAxis(axisIs(ABS_X, 32767), GamepadAxis::kLeftX, 1.0);
  expectAxis(axisIs(ABS_X, -32768), GamepadAxis::kLeftX, -1.0);
  expectAxis(axisIs(ABS_Y, -32768), GamepadAxis::kLeftY, 1.0);
  expectAxis(axisIs(ABS_RY, 32767), GamepadAxis::kRightY, -1.0);
  expectAxis(axisIs(ABS_RX, 18022), GamepadAxis::kRightX, 0.5);
}

TEST_F(PadDecoderTest, AStickThatIsNotQuiteInTheMiddleIsAtRest) {
  EXPECT_TRUE(axisIs(ABS_X, 3000).empty());
  EXPECT_TRUE(axisIs(ABS_X, -3000).empty());
  expectAxis(axisIs(ABS_X, 3300), GamepadAxis::kLeftX, 0.0008);
  expectAxis(axisIs(ABS_X, 100), GamepadAxis::kLeftX, 0.0);
  EXPECT_TRUE(axisIs(ABS_X, 200).empty()) << "nothing has changed";
}

TEST_F(PadDecoderTest, WhatTheKernelCallsFlatMayBeMore) {
  PadTraits worn = xpad();
  worn.axes[ABS_X].flat = 8192;
  PadDecoder decoder(worn);
  EXPECT_TRUE(decoder.decode({EV_ABS, ABS_X, 8000}).empty());
  EXPECT_FALSE(decoder.decode({EV_ABS, ABS_X, 8400}).empty());
}

TEST_F(PadDecoderTest, TriggersGoFromOneEndToTheOther) {
  expectAxis(axisIs(ABS_Z, 255), GamepadAxis::kLeftTrigger, 1.0);
  expectAxis(axisIs(ABS_Z, 0), GamepadAxis::kLeftTrigger, 0.0);
  EXPECT_TRUE(axisIs(ABS_RZ, 4).empty()) << "it is at rest";
  expectAxis(axisIs(ABS_RZ, 130), GamepadAxis::kRightTrigger, 0.49978);
}

TEST_F(PadDecoderTest, ButtonsGoDownAndUpOnce) {
  expectButton(keyIs(BTN_SOUTH, 1), GamepadButton::kSouth, 1.0);
  EXPECT_TRUE(keyIs(BTN_SOUTH, 2).empty()) << "it repeats";
  expectButton(keyIs(BTN_SOUTH, 0), GamepadButton::kSouth, 0.0);
  expectButton(keyIs(BTN_THUMBR, 1), GamepadButton::kRightStick, 1.0);
  expectButton(keyIs(BTN_DPAD_UP, 1), GamepadButton::kDpadUp, 1.0);
  EXPECT_TRUE(keyIs(BTN_MODE, 1).empty());
  EXPECT_TRUE(keyIs(BTN_TL2, 1).empty()) << "the trigger itself tells more";
}

TEST_F(PadDecoderTest, AHatIsFourButtons) {
  expectButton(axisIs(ABS_HAT0X, -1), GamepadButton::kDpadLeft, 1.0);
  const auto over = axisIs(ABS_HAT0X, 1);
  ASSERT_EQ(over.size(), 2U);
  EXPECT_EQ(over[0].number, static_cast<int>(GamepadButton::kDpadLeft));
  EXPECT_EQ(over[0].value, 0.0);
  EXPECT_EQ(over[1].number, static_cast<int>(GamepadButton::kDpadRight));
  expectButton(axisIs(ABS_HAT0X, 0), GamepadButton::kDpadRight, 0.0);
  expectButton(axisIs(ABS_HAT0Y, 1), GamepadButton::kDpadDown, 1.0);
}

TEST_F(PadDecoderTest, OtherEventsMeanNothing) {
  EXPECT_TRUE(decoder_.decode({EV_SYN, SYN_REPORT, 0}).empty());
  EXPECT_TRUE(axisIs(ABS_THROTTLE, 7).empty());
}

TEST_F(PadDecoderTest, AGamepadWithoutTheUsualRightStickHasItWhereOthersHaveTriggers) {
  PadTraits traits = {"generic",
                      {{ABS_X, {0, 255, 15}},
                       {ABS_Y, {0, 255, 15}},
                       {ABS_Z, {0, 255, 15}},
                       {ABS_RZ, {0, 255, 15}}}};
  PadDecoder without_triggers(traits);
  expectAxis(without_triggers.decode({EV_ABS, ABS_RZ, 0}), GamepadAxis::kRightY, 1.0);
  expectAxis(without_triggers.decode({EV_KEY, BTN_TR2, 1}), GamepadAxis::kRightTrigger, 1.0);
  traits.axes[ABS_BRAKE] = kTrigger;
  traits.axes[ABS_GAS] = kTrigger;
  PadDecoder with_triggers(traits);
  expectAxis(with_triggers.decode({EV_ABS, ABS_Z, 255}), GamepadAxis::kRightX, 1.0);
  expectAxis(with_triggers.decode({EV_ABS, ABS_GAS, 255}), GamepadAxis::kRightTrigger, 1.0);
  expectAxis(with_triggers.decode({EV_ABS, ABS_BRAKE, 255}), GamepadAxis::kLeftTrigger, 1.0);
  EXPECT_TRUE(with_triggers.decode({EV_KEY, BTN_TR2, 1}).empty());
}

TEST_F(PadDecoderTest, AnAxisWithoutARangeIsNone) {
  PadDecoder decoder(PadTraits{"broken", {{ABS_X, {7, 7, 0}}}});
  EXPECT_TRUE(decoder.decode({EV_ABS, ABS_X, 7}).empty());
}

TEST(EvdevPadTest, TellsWhatLibevdevKnows) {
  libevdev* const device = libevdev_new();
  libevdev_set_name(device, "Some pad");
  input_absinfo range{};
  range.minimum = -5;
  range.maximum = 90;
  range.flat = 3;
  libevdev_enable_event_code(device, EV_ABS, ABS_RX, &range);
  const PadTraits traits = traitsOf(device);
  libevdev_free(device);
  EXPECT_EQ(traits.name, "Some pad");
  ASSERT_EQ(traits.axes.size(), 1U);
  EXPECT_EQ(traits.axes.at(ABS_RX).low, -5);
  EXPECT_EQ(traits.axes.at(ABS_RX).high, 90);
  EXPECT_EQ(traits.axes.at(ABS_RX).flat, 3);
}

TEST(EvdevPadTest, RefusesWhatIsNoDevice) {
  EXPECT_THROW(openByEvdev("/tmp/there_is_nothing"), std::system_error);
  EXPECT_THROW(openByEvdev("/dev/null"), std::system_error);
}

TEST(GamepadButtonsTest, AreFoundInTheListOfTheKernel) {
  EXPECT_TRUE(hasGamepadButtons("7cdb000000000000 0 0 0 0\n")) << "an Xbox pad";
  EXPECT_FALSE(hasGamepadButtons("402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe"))
      << "a keyboard";
  EXPECT_FALSE(hasGamepadButtons("1f0000 0 0 0 0")) << "a mouse";
  EXPECT_FALSE(hasGamepadButtons(""));
  EXPECT_FALSE(hasGamepadButtons("no hexadecimal words"));
}

}  // namespace
}  // namespace ergotic::gamepads
