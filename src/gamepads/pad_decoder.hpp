// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "ergotic/tgr/players/gamepad.hpp"
#include "gamepads/pad_device.hpp"

namespace ergotic::gamepads {

/// Converts events of the kernel to moves of a gamepad. Which code is which stick or trigger
/// differs between gamepads, and follows from what they have (the kernel's
/// Documentation/input/gamepad.rst, and what its drivers xpad and hid-generic do). All controls
/// begin at rest; unchanged values are not reported. Thread: one
class PadDecoder {
 public:
  explicit PadDecoder(const PadTraits& traits);

  std::vector<tgr::GamepadMove> decode(const PadEvent& event);

  /// Dead zone of a stick, as a share of its range from the middle: sticks do not come back
  /// exactly. Beyond it the output rises linearly to the end.
  static constexpr double kStickRest = 0.1;
  static constexpr double kTriggerRest = 0.02;  ///< dead zone of a trigger, likewise

 private:
  struct Axis {
    tgr::GamepadAxis axis;
    PadTraits::Range range;
    double shareOf(int value) const;
  };
  void addAxis(const PadTraits& traits, tgr::GamepadAxis axis, int code);
  void tellButton(tgr::GamepadButton button, bool is_down, std::vector<tgr::GamepadMove>& moves);
  void tellAxis(tgr::GamepadAxis axis, double value, std::vector<tgr::GamepadMove>& moves);

  std::map<int, Axis> axes_;                      // by code
  std::map<int, tgr::GamepadAxis> key_triggers_;  // by code: triggers that know only up and down
  std::map<tgr::GamepadAxis, double> values_;
  std::map<tgr::GamepadButton, bool> is_down_;
};

}  // namespace ergotic::gamepads
