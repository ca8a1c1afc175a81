// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ergotic::tgr {

/// How some notes move a hand: a line of a map.
struct KeyLine {
  int first_note = 0;  ///< MIDI numbers, 60 is middle C
  int last_note = 127;
  /// Slices, or coordinates of an end-effector; note first_note + i moves number i of them, and
  /// from the last on it begins anew.
  std::vector<int> indices;
  std::string end_effector;  ///< whose coordinates these are; empty: they are slices
  double from_m = 0.0;       ///< where the hand rests
  double to_m = 0.0;         ///< where it goes
  double slowest = 0.05;     ///< m/s, greatest speed of the hand at velocity 1
  double fastest = 1.0;      ///< at velocity 127; between them evenly in the logarithm
  double back = 0.3;         ///< m/s, greatest speed of its way back
  bool strikes = false;      ///< goes back at once; else when the key is released
};

/// A controller that moves a parameter of the scene over its range.
struct ControllerLine {
  int controller = 0;  ///< MIDI number
  std::string parameter;
};

struct PlayMap {
  std::vector<KeyLine> keys;
  std::vector<ControllerLine> controllers;
  int transpose = 0;  ///< semitones, added to each note
};

/// Reads `{keys: [{notes: [0, 59], slices: 0, to: 20 mm, ...}], controllers: [...], transpose: 0}`;
/// docs/ros.md has all keys. \throws TextError with file:line:col, value and allowed range
PlayMap readPlayMap(const std::string& text, const std::string& name);

/// Where a hand shall go.
struct Stroke {
  std::string end_effector;  ///< empty: `index` is a slice
  int index = 0;
  double target_m = 0.0;
  double glide_s = 0.0;  ///< on a path of minimum jerk that takes so long
  double after_s = 0.0;  ///< it begins so much later than the note
};

/// Turns notes into strokes of hands, as MIDI instruments understand notes: a note with velocity 0
/// is a release, the sustain pedal (controller 64) keeps keys down until it is up, "all sound off"
/// and "all notes off" (120, 123) release everything.
///
/// The launch law: the hand goes from `from_m` to `to_m` on a path of minimum jerk, whose greatest
/// speed is the one that the velocity says; what it throws leaves at that speed. Thread: one
class Keyboard {
 public:
  /// What becomes of a message.
  struct Played {
    std::vector<Stroke> strokes;
    std::string parameter;  ///< empty: none
    double share = 0.0;     ///< of its range
  };

  /// Other notes and controllers mean something from now on. \return strokes that release all
  std::vector<Stroke> use(PlayMap map);

  /// \param bytes  of a MIDI message. What means nothing here is passed over
  Played play(const std::uint8_t* bytes, int size);
  /// \param note  0...127. \param velocity  0...127; 0: release
  std::vector<Stroke> note(int note, int velocity);
  std::vector<Stroke> releaseAll();

 private:
  struct Key {
    const KeyLine* line;
    int index;
  };
  std::optional<Key> keyOf(int note) const;
  bool isDown(const Key& key) const;
  std::vector<Stroke> press(int note, int velocity);
  std::vector<Stroke> release(int note);
  std::vector<Stroke> setPedal(bool is_down);
  static Stroke stroke(const Key& key, double target_m, double speed);

  PlayMap map_;
  bool pedal_ = false;
  std::map<int, bool> down_;  // notes whose keys are down; true: only the pedal keeps them
};

}  // namespace ergotic::tgr
