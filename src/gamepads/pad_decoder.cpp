// SPDX-License-Identifier: BSD-3-Clause
#include "gamepads/pad_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <linux/input-event-codes.h>

namespace ergotic::gamepads {
namespace {

using tgr::GamepadAxis;
using tgr::GamepadButton;

const std::map<int, GamepadButton> kButtons = {{BTN_SOUTH, GamepadButton::kSouth},
                                               {BTN_EAST, GamepadButton::kEast},
                                               {BTN_WEST, GamepadButton::kWest},
                                               {BTN_NORTH, GamepadButton::kNorth},
                                               {BTN_TL, GamepadButton::kLeftBumper},
                                               {BTN_TR, GamepadButton::kRightBumper},
                                               {BTN_THUMBL, GamepadButton::kLeftStick},
                                               {BTN_THUMBR, GamepadButton::kRightStick},
                                               {BTN_SELECT, GamepadButton::kSelect},
                                               {BTN_START, GamepadButton::kStart},
                                               {BTN_DPAD_LEFT, GamepadButton::kDpadLeft},
                                               {BTN_DPAD_UP, GamepadButton::kDpadUp},
                                               {BTN_DPAD_RIGHT, GamepadButton::kDpadRight},
                                               {BTN_DPAD_DOWN, GamepadButton::kDpadDown}};

bool isStick(GamepadAxis axis) {
  return axis < GamepadAxis::kLeftTrigger;
}

/// Forward is less in the kernel.
bool isUpsideDown(GamepadAxis axis) {
  return axis == GamepadAxis::kLeftY || axis == GamepadAxis::kRightY;
}

/// Applies the dead zone `rest`; beyond it the value rises linearly to 1.
double beyondRest(double share, double rest) {
  const double way = std::abs(share);
  return way <= rest ? 0.0 : std::copysign(std::min((way - rest) / (1.0 - rest), 1.0), share);
}

/// Returns the first of some codes that the gamepad has; 0: none, as ABS_X is always the left
/// stick.
int firstOf(const PadTraits& traits, std::initializer_list<int> codes) {
  const auto found = std::find_if(codes.begin(), codes.end(),
                                  [&](int code) { return traits.axes.count(code) > 0; });
  return found == codes.end() ? 0 : *found;
}

}  // namespace

double PadDecoder::Axis::shareOf(int value) const {
  const double low = range.low;
  const double way = range.high - low;
  const double from_low = (value - low) / way;
  if (!isStick(axis)) {
    return std::max(beyondRest(from_low, std::max(kTriggerRest, range.flat / way)), 0.0);
  }
  const double from_middle = 2.0 * from_low - 1.0;
  return beyondRest(isUpsideDown(axis) ? -from_middle : from_middle,
                    std::max(kStickRest, 2.0 * range.flat / way));
}

PadDecoder::PadDecoder(const PadTraits& traits) {
  addAxis(traits, GamepadAxis::kLeftX, ABS_X);
  addAxis(traits, GamepadAxis::kLeftY, ABS_Y);
  const bool has_usual_right = traits.axes.count(ABS_RX) > 0 && traits.axes.count(ABS_RY) > 0;
  addAxis(traits, GamepadAxis::kRightX, has_usual_right ? ABS_RX : ABS_Z);
  addAxis(traits, GamepadAxis::kRightY, has_usual_right ? ABS_RY : ABS_RZ);
  const int left = has_usual_right ? firstOf(traits, {ABS_HAT2Y, ABS_BRAKE, ABS_Z})
                                   : firstOf(traits, {ABS_HAT2Y, ABS_BRAKE});
  const int right = has_usual_right ? firstOf(traits, {ABS_HAT2X, ABS_GAS, ABS_RZ})
                                    : firstOf(traits, {ABS_HAT2X, ABS_GAS});
  if (left != 0) {
    addAxis(traits, GamepadAxis::kLeftTrigger, left);
  } else {
    key_triggers_.emplace(BTN_TL2, GamepadAxis::kLeftTrigger);
  }
  if (right != 0) {
    addAxis(traits, GamepadAxis::kRightTrigger, right);
  } else {
    key_triggers_.emplace(BTN_TR2, GamepadAxis::kRightTrigger);
  }
}

void PadDecoder::addAxis(const PadTraits& traits, GamepadAxis axis, int code) {
  const auto found = traits.axes.find(code);
  if (found != traits.axes.end() && found->second.low < found->second.high) {
    axes_.emplace(code, Axis{axis, found->second});
  }
}

std::vector<tgr::GamepadMove> PadDecoder::decode(const PadEvent& event) {
  std::vector<tgr::GamepadMove> moves;
  if (event.type == EV_KEY) {
    if (const auto button = kButtons.find(event.code); button != kButtons.end()) {
      tellButton(button->second, event.value != 0, moves);
    } else if (const auto trigger = key_triggers_.find(event.code);
               trigger != key_triggers_.end()) {
      tellAxis(trigger->second, event.value != 0 ? 1.0 : 0.0, moves);
    }
  } else if (event.type == EV_ABS && event.code == ABS_HAT0X) {
    tellButton(GamepadButton::kDpadLeft, event.value < 0, moves);
    tellButton(GamepadButton::kDpadRight, event.value > 0, moves);
  } else if (event.type == EV_ABS && event.code == ABS_HAT0Y) {
    tellButton(GamepadButton::kDpadUp, event.value < 0, moves);
    tellButton(GamepadButton::kDpadDown, event.value > 0, moves);
  } else if (const auto axis = axes_.find(event.code);
             event.type == EV_ABS && axis != axes_.end()) {
    tellAxis(axis->second.axis, axis->second.shareOf(event.value), moves);
  }
  return moves;
}

void PadDecoder::tellButton(GamepadButton button,
                            bool is_down,
                            std::vector<tgr::GamepadMove>& moves) {
  bool& was_down = is_down_[button];
  if (was_down != is_down) {
    moves.push_back({true, static_cast<int>(button), is_down ? 1.0 : 0.0});
    was_down = is_down;
  }
}

void PadDecoder::tellAxis(GamepadAxis axis, double value, std::vector<tgr::GamepadMove>& moves) {
  double& before = values_[axis];
  if (before != value) {
    moves.push_back({false, static_cast<int>(axis), value});
    before = value;
  }
}

}  // namespace ergotic::gamepads
