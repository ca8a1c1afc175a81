// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ergotic/tgr/players/control.hpp"
#include "ergotic/tgr/players/gamepad.hpp"

namespace ergotic::tgr {

/// What something moves that has any value between two ends: a parameter of the scene, or hands.
struct Motion {
  std::string parameter;     ///< goes over its whole range; empty: hands move
  std::vector<int> indices;  ///< slices, or coordinates of an end-effector
  std::string end_effector;  ///< whose coordinates these are; empty: they are slices
  double from_m = 0.0;       ///< where the hands are at one end
  double to_m = 0.0;         ///< and at the other
  double speed = 1.0;        ///< m/s, greatest one of the hands
};

/// How some notes move a hand: a line of a map.
struct KeyLine {
  int first_note = 0;  ///< MIDI numbers, 60 is middle C
  int last_note = 127;
  /// Slices, or coordinates of an end-effector; note first_note + i moves number i of them, and
  /// from the last on it begins anew.
  std::vector<int> indices;
  std::string end_effector;             ///< whose coordinates these are; empty: they are slices
  double from_m = 0.0;                  ///< where the hand rests
  double to_m = 0.0;                    ///< where it goes
  double slowest = 0.05;                ///< m/s, greatest speed of the hand at velocity 1
  double fastest = 1.0;                 ///< at velocity 127; between them evenly in the logarithm
  double back = 0.3;                    ///< m/s, greatest speed of its way back
  bool strikes = false;                 ///< goes back at once; else when the key is released
  std::optional<double> pressure_to_m;  ///< where it goes when the key is pressed with all force
  /// What bend and slide (controller 74) of the note move, hands of them as many as of notes.
  std::optional<Motion> bend, slide;
};

/// A control that moves something.
struct ControlLine {
  Control control;
  Motion motion;
};

struct PlayMap {
  std::vector<KeyLine> keys;
  std::vector<ControlLine> controls;  ///< by MIDI, and of gamepads
  std::vector<ButtonLine> buttons;    ///< of gamepads
  bool has_gamepad = false;           ///< it says what gamepads do; else they do what is usual
  int transpose = 0;                  ///< semitones, added to each note
  /// Each note has a channel of its own (MPE); nothing: if the player's device says so.
  std::optional<bool> mpe;
};

/// Reads `{keys: [{notes: [0, 59], slices: 0, to: 20 mm, ...}], controllers: [...], gamepad: [...],
/// transpose: 0}`; docs/ros.md has all keys. \throws TextError with file:line:col, value and
/// allowed range
PlayMap readPlayMap(const std::string& text, const std::string& name);

}  // namespace ergotic::tgr
