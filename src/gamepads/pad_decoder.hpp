// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "ergotic/tgr/players/gamepad.hpp"
#include "gamepads/pad_device.hpp"

namespace ergotic::gamepads {

/// Makes moves of a gamepad of what the kernel tells of one. Which code is which stick or trigger
/// differs between gamepads, and follows from what they have (the kernel's
/// Documentation/input/gamepad.rst, and what its drivers xpad and hid-generic do). All begins at
/// rest; what has not changed is not told. Thread: one
class PadDecoder {
 public:
  explicit PadDecoder(const PadTraits& traits);

  std::vector<tgr::GamepadMove> decode(const PadEvent& event);

  /// Of the way of a stick from its middle, of which nothing is told: sticks do not come back
  /// exactly. What is told goes on evenly from there, to the end.
  static constexpr double kStickRest = 0.1;
  static constexpr double kTriggerRest = 0.02;  ///< of the way of a trigger, the same

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
