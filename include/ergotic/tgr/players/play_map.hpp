// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ergotic/tgr/players/control.hpp"
#include "ergotic/tgr/players/gamepad.hpp"
#include "ergotic/tgr/players/hand_ways.hpp"

namespace ergotic::tgr {

/// Motion between two ends by a continuous control: of a parameter of the scene, or of hands.
struct Motion {
  std::string parameter;     ///< parameter, over its whole range; empty: hands move
  std::vector<int> indices;  ///< slices, or coordinates of an end-effector
  std::string end_effector;  ///< end-effector of these coordinates; empty: they are slices
  double from_m = 0.0;       ///< position of the hands at one end
  double to_m = 0.0;         ///< position at the other end
  double speed = 1.0;        ///< peak speed of the hands, m/s
};

/// What a hand does whose key is pressed while it is not at rest.
enum class Legato {
  kLifts,   ///< it comes up, and is pressed again
  kGlides,  ///< it goes from where it is to the place of the new note
  kTurns    ///< it goes to the end of its way that is farther, as a bow does
};

/// What a hand does when its key is released.
enum class Release {
  kReturns,  ///< it goes back to its rest
  kStays,    ///< it goes on to where the note sent it, and stays there
  kStops     ///< it stops where it is
};

/// Motion of one hand by each note of a range.
struct KeyMove {
  /// Slices, or coordinates of an end-effector; note first_note + i moves number i of them, and
  /// after the last one the sequence begins anew.
  std::vector<int> indices;
  std::string end_effector;  ///< end-effector of these coordinates; empty: they are slices
  double from_m = 0.0;       ///< rest position of the hand
  std::vector<double> to_m;  ///< position of a pressed key: of all notes, or one for each
  double slowest = 0.05;     ///< peak speed at velocity 1, m/s
  double fastest = 1.0;      ///< peak speed at velocity 127; logarithmic in between
  double back = 0.3;         ///< peak speed of the return, m/s
  double after_s = 0.0;      ///< the hand begins so much later than the note
  bool strikes = false;      ///< returns at once; else when the key is released
  Release release = Release::kReturns;
  Legato legato = Legato::kLifts;
  std::optional<double> pressure_to_m;  ///< position under full key pressure

  HandWays::Hand handOf(std::size_t number) const {
    return {end_effector, indices[number % indices.size()]};
  }
  double toOf(std::size_t number) const { return to_m[number % to_m.size()]; }
};

/// Motion of hands by a range of notes: one line of a map.
struct KeyLine {
  int first_note = 0;  ///< MIDI numbers, 60 is middle C
  int last_note = 127;
  std::vector<KeyMove> moves;  ///< of the hands that a note moves, one or more
  /// Motions by bend and by slide (controller 74) of the note, with one hand for each note.
  std::optional<Motion> bend, slide;
};

/// A control that moves something.
struct ControlLine {
  Control control;
  Motion motion;
};

struct PlayMap {
  std::vector<KeyLine> keys;
  std::vector<ControlLine> controls;  ///< MIDI controls and gamepad axes
  std::vector<ButtonLine> buttons;    ///< buttons of gamepads
  bool has_gamepad = false;  ///< the map defines gamepads; else the usual assignment applies
  int transpose = 0;         ///< semitones, added to each note
  /// Whether each note has a channel of its own (MPE); empty: as the player's device says.
  std::optional<bool> mpe;
};

/// Reads `{keys: [{notes: [0, 59], slices: 0, to: 20 mm, ...}], controllers: [...], gamepad: [...],
/// transpose: 0}`; docs/ros.md has all keys. \throws TextError with file:line:col, value and
/// allowed range
PlayMap readPlayMap(const std::string& text, const std::string& name);

}  // namespace ergotic::tgr
