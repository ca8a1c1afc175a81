// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ergotic::tgr {

/// A button of a gamepad, by its place: the four on the right by their compass points.
enum class GamepadButton : std::uint8_t {
  kSouth,
  kEast,
  kWest,
  kNorth,
  kLeftBumper,
  kRightBumper,
  kDpadLeft,
  kDpadUp,
  kDpadRight,
  kDpadDown,
  kLeftStick,
  kRightStick,
  kSelect,
  kStart
};

/// Continuous axes: sticks -1...1, right and forward are positive, 0 when they are released;
/// triggers 0...1.
enum class GamepadAxis : std::uint8_t {
  kLeftX,
  kLeftY,
  kRightX,
  kRightY,
  kLeftTrigger,
  kRightTrigger
};

/// Names in a map of notes, in the order of the enumerations: "south", "left_x".
const std::vector<std::string>& gamepadButtonNames();
const std::vector<std::string>& gamepadAxisNames();

/// A button went down or came up, or an axis has another value.
struct GamepadMove {
  bool is_button = false;
  int number = 0;      ///< number of the GamepadButton or GamepadAxis
  double value = 0.0;  ///< value of the axis; of a button 1 or 0
};

/// A button that plays a note: a line of a map.
struct ButtonLine {
  int button = 0;
  int note = 0;  ///< note, as of a MIDI key: `transpose` is added to it
  int velocity = 100;
};

}  // namespace ergotic::tgr
