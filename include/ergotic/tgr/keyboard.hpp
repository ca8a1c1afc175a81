// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ergotic/tgr/players/control.hpp"
#include "ergotic/tgr/players/gamepad.hpp"
#include "ergotic/tgr/players/hand_ways.hpp"
#include "ergotic/tgr/players/play_map.hpp"

namespace ergotic::tgr {

/// Turns notes and controls into strokes of hands, as MIDI instruments understand them: a note with
/// velocity 0 is a release, the sustain pedal (controller 64) keeps keys down, sostenuto (66) those
/// that were down before it, the soft pedal (67) makes strokes slower, "all sound off" and "all
/// notes off" (120, 123 and above) release everything. A key is down as long as it is on any
/// channel. Buttons of gamepads are keys, too, and their axes are controls.
///
/// The launch law: the hand goes from `from_m` to `to_m` on a path of minimum jerk, whose greatest
/// speed is the one that the velocity says; what it throws leaves at that speed.
///
/// The half pedal: up to a quarter of its way the sustain pedal keeps nothing, from three quarters
/// on the keys that it keeps are down, and between these they are as far down as the pedal is.
///
/// `now_s` is a time in s, of one clock that does not go back. Thread: one
class Keyboard {
 public:
  /// Result of a message.
  struct Played {
    Strokes strokes;
    std::vector<ParameterChange> changes;
    std::optional<Learner::Learnt> learnt;
    std::optional<int> program;  ///< 0...127
  };

  /// Uses another map of notes and controls from now on. Learnt bindings stay.
  /// \return strokes that release all keys, and all hands that controls moved
  Strokes use(PlayMap map, double now_s);

  /// \param bytes  of a MIDI message. What means nothing here is passed over
  Played play(const std::uint8_t* bytes, int size, double now_s);
  /// \param pad  number of the gamepad, 0 or more
  Played play(const GamepadMove& move, int pad, double now_s);
  /// A gamepad is gone: its notes end, and hands that its axes moved are let go of.
  Strokes unplug(int pad, double now_s);
  /// The first note, as it is given to `note`, of the first line of the map that begins with this
  /// hand, else of the first one that moves it.
  std::optional<int> noteOf(const HandWays::Hand& hand) const;

  /// Plays a note without a channel.
  /// \param note  0...127. \param velocity  0...127; 0: release
  Strokes note(int note, int velocity, double now_s);
  Strokes releaseAll(double now_s);
  /// Resets the state after all hands have let go by themselves; no key is down then.
  void forgetHands();

  /// Binds controls to parameters, in place of what the map says of them.
  Learner& learner() { return learner_; }

 private:
  /// A note that the map has.
  struct Note {
    const KeyLine* line;
    std::size_t number;  // of the note in its line
  };
  /// One of the hands that a note moves.
  struct Key {
    const KeyMove* move;
    std::size_t number;
    HandWays::Hand hand;
  };
  using Name = std::pair<int, int>;  // channel and note of a key
  struct Down {
    bool is_held = false;    // by a finger; else a pedal keeps it
    bool is_caught = false;  // by sostenuto
    std::int64_t order = 0;  // later notes have larger numbers
    double pressure = 0.0;
  };
  /// What the notes that are down want of one hand; those that strike want nothing of it.
  struct Wish {
    std::optional<Key> key;  // of those that are down most, the last one; none: all are up
    double depth = 0.0;      // how far it is down, 0...1
    double pressure = 0.0;   // the largest, of fingers
  };
  /// Where a note has put a hand, and between which places notes of its line put it, m.
  struct Placed {
    double at_m = 0.0;
    double least_m = 0.0;
    double most_m = 0.0;
  };
  /// Expression values last received on a channel; a note that begins on it starts with these.
  struct Expression {
    double bend = 0.0;
    double slide = 64.0 / 127.0;
    double pressure = 0.0;
  };

  /// State of one gamepad.
  struct Pad {
    std::set<int> buttons;  // that are down
    std::set<int> axes;     // that have moved since there is this map
  };

  std::optional<Note> lineOf(int note) const;
  std::vector<Key> keysOf(int note) const;
  double depthOf(const Down& down) const;
  Wish wishOf(const HandWays::Hand& hand) const;
  static double placeOf(const Wish& wish);
  double strike(const Key& key, double target_m, double speed, double after_s, Strokes& strokes);
  void press(const Key& key, double velocity, Strokes& strokes);
  void turn(const Key& key, double speed, Strokes& strokes);
  void press(const Name& name, int velocity, Strokes& strokes);
  void release(const Name& name, Strokes& strokes);
  void keepTogether(const std::vector<Key>& keys);
  void goBack(const Key& key, Strokes& strokes);
  void goOn(const Key& key, const Wish& before, Strokes& strokes);
  void settle(const Key& key, Strokes& strokes);
  void setPedal(int number, int value, Strokes& strokes);
  void catchKeys(bool is_down, Strokes& strokes);
  void settleKept(Strokes& strokes);

  // keyboard_controls.cpp:
  void playNote(const Name& name, int velocity, Played& played);
  void setController(int channel, int number, int value, Played& played);
  void resetControls(int channel, Played& played);
  void setKeyPressure(int channel, int note, int value, Played& played);
  void setControl(const Control& control, int channel, double share, Played& played);
  void express(const Control& control, std::optional<int> channel, double share, Played& played);
  void followPressure(int note, Strokes& strokes);
  void moveFor(const Note& note, const Control& control, double share, Played& played);
  void moveByMap(const Control& control, double share, Played& played);
  void move(const Motion& motion,
            std::optional<std::size_t> number,
            const Control& control,
            double share,
            Played& played);

  // keyboard_gamepad.cpp:
  void useUsualGamepad();
  bool hasMoved(int axis) const;
  void playButton(int pad, int button, bool is_down, Strokes& strokes);

  PlayMap map_;
  HandWays ways_;
  Learner learner_;
  MpeZones zones_;
  double now_s_ = 0.0;
  double pedal_depth_ = 0.0;  // how far down the sustain pedal keeps keys, 0...1
  double soft_ = 0.0;         // 0...1
  bool sostenuto_ = false;
  std::int64_t pressed_ = 0;  // notes so far
  std::map<Name, Down> down_;
  std::map<HandWays::Hand, Placed> placed_;    // hands that stay where notes have put them
  std::map<HandWays::Hand, double> needed_s_;  // until when other hands of their notes need them
  std::map<int, Pad> pads_;
  std::map<Name, int> key_pressures_;         // those above 0
  std::array<Expression, 16> expressions_{};  // [channels]
};

}  // namespace ergotic::tgr
