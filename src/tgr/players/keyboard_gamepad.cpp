// SPDX-License-Identifier: BSD-3-Clause
// Gamepads: buttons are keys, sticks and triggers are controls.
#include <algorithm>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/keyboard.hpp"

namespace ergotic::tgr {
namespace {

constexpr int kFirstPad = 17;  // as a channel of notes: those of MIDI, and none, come before

Control axisControl(int axis) {
  return {Control::Kind::kAxis, axis};
}

/// Limits a target to the range of a hand at a slice; coordinates have no limit.
double withinReach(double target_m, bool is_slice) {
  return is_slice ? std::clamp(target_m, -kMaxTargetM, kMaxTargetM) : target_m;
}

}  // namespace

const std::vector<std::string>& gamepadButtonNames() {
  static const std::vector<std::string> names = {
      "south",        "east",        "west",    "north",      "left_bumper",
      "right_bumper", "dpad_left",   "dpad_up", "dpad_right", "dpad_down",
      "left_stick",   "right_stick", "select",  "start"};
  return names;
}

const std::vector<std::string>& gamepadAxisNames() {
  static const std::vector<std::string> names = {"left_x",  "left_y",       "right_x",
                                                 "right_y", "left_trigger", "right_trigger"};
  return names;
}

/// Usual assignment, for a map without gamepads: a button for each hand, in the order of the map,
/// and the left stick for the first two hands: forwards and to the right move them like their keys,
/// the opposite directions move them as far to the other side.
void Keyboard::useUsualGamepad() {
  std::vector<HandWays::Hand> hands;
  std::vector<const KeyMove*> moves;  // [hands]
  for (const KeyLine& line : map_.keys) {
    const KeyMove& move = line.moves.front();
    for (std::size_t i = 0; i < move.indices.size(); ++i) {
      const HandWays::Hand hand = move.handOf(i);
      if (std::find(hands.begin(), hands.end(), hand) == hands.end() && noteOf(hand)) {
        hands.push_back(hand);
        moves.push_back(&move);
      }
    }
  }
  for (std::size_t i = 0; i < std::min(hands.size(), gamepadButtonNames().size()); ++i) {
    map_.buttons.push_back({static_cast<int>(i), *noteOf(hands[i])});
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(hands.size(), 2); ++i) {
    const auto axis = i == 0 ? GamepadAxis::kLeftY : GamepadAxis::kLeftX;
    Motion motion;
    motion.end_effector = hands[i].first;
    motion.indices = {hands[i].second};
    motion.to_m = moves[i]->to_m.front();
    motion.from_m = moves[i]->legato == Legato::kTurns
                        ? moves[i]->from_m
                        : withinReach(2.0 * moves[i]->from_m - motion.to_m, hands[i].first.empty());
    map_.controls.push_back({axisControl(static_cast<int>(axis)), motion});
  }
}

/// Hands that no axis has moved yet are those of their keys alone.
bool Keyboard::hasMoved(int axis) const {
  return std::any_of(pads_.begin(), pads_.end(),
                     [axis](const auto& pad) { return pad.second.axes.count(axis) > 0; });
}

Keyboard::Played Keyboard::play(const GamepadMove& move, int pad, double now_s) {
  now_s_ = now_s;
  Played played;
  if (move.is_button) {
    playButton(pad, move.number, move.value > 0.0, played.strokes);
  } else {
    pads_[pad].axes.insert(move.number);
    moveByMap(axisControl(move.number), move.value, played);
  }
  return played;
}

void Keyboard::playButton(int pad, int button, bool is_down, Strokes& strokes) {
  std::set<int>& down = pads_[pad].buttons;
  if (is_down) {
    down.insert(button);
  } else {
    down.erase(button);
  }
  const auto is_held = [&](int note) {
    return std::any_of(map_.buttons.begin(), map_.buttons.end(), [&](const ButtonLine& line) {
      return line.note == note && down.count(line.button) > 0;
    });
  };
  for (const ButtonLine& line : map_.buttons) {
    if (line.button != button) {
      continue;
    }
    if (is_down) {
      press({kFirstPad + pad, line.note}, line.velocity, strokes);
    } else if (!is_held(line.note)) {
      release({kFirstPad + pad, line.note}, strokes);
    }
  }
}

Strokes Keyboard::unplug(int pad, double now_s) {
  now_s_ = now_s;
  Strokes strokes;
  const Pad gone = pads_[pad];
  for (const int button : gone.buttons) {
    playButton(pad, button, false, strokes);
  }
  pads_.erase(pad);
  for (const ControlLine& line : map_.controls) {
    if (line.control.kind == Control::Kind::kAxis && gone.axes.count(line.control.number) > 0) {
      for (const int index : line.motion.indices) {
        ways_.letGo({line.motion.end_effector, index}, strokes);
      }
    }
  }
  return strokes;
}

}  // namespace ergotic::tgr
