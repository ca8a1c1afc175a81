// SPDX-License-Identifier: BSD-3-Clause
// MIDI messages, and what bends, presses and turns.
#include <algorithm>

#include "ergotic/tgr/keyboard.hpp"

namespace ergotic::tgr {
namespace {

using Kind = Control::Kind;

constexpr double kMax = 127.0;
enum Status : std::uint8_t {
  kNoteOff = 0x80,
  kNoteOn = 0x90,
  kKeyPressure = 0xa0,
  kController = 0xb0,
  kProgram = 0xc0,
  kChannelPressure = 0xd0,
  kBend = 0xe0
};
enum Number : std::uint8_t {
  kSlide = 74,
  kAllSoundOff = 120,
  kResetControllers = 121,
  kLocalControl = 122,
  kAllNotesOff = 123  // and above, the modes, which release all as well
};
const Control kBendControl{Kind::kBend, 0};
const Control kPressureControl{Kind::kPressure, 0};
const Control kSlideControl{Kind::kController, kSlide};

/// Banks, pedals and registered parameters are not learnt.
bool hasAMeaning(int number) {
  constexpr std::array<int, 13> kWithMeaning{0, 6, 32, 38, 64, 66, 67, 96, 97, 98, 99, 100, 101};
  return std::find(kWithMeaning.begin(), kWithMeaning.end(), number) != kWithMeaning.end();
}

bool isOfNotes(const Control& control) {
  return control == kBendControl || control == kPressureControl || control == kSlideControl;
}

}  // namespace

Keyboard::Played Keyboard::play(const std::uint8_t* bytes, int size, double now_s) {
  constexpr std::uint8_t kWithoutChannel = 0xf0;
  constexpr std::uint8_t kChannel = 0x0f;
  Played played;
  const int status = size > 0 ? bytes[0] & kWithoutChannel : 0;
  const int length = status == kProgram || status == kChannelPressure ? 2 : 3;
  const auto is_datum = [](std::uint8_t byte) { return byte <= kMax; };
  if (size < length || !std::all_of(bytes + 1, bytes + length, is_datum)) {
    return played;
  }
  now_s_ = now_s;
  const int channel = bytes[0] & kChannel;
  const int first = bytes[1];
  const int second = length > 2 ? bytes[2] : 0;
  switch (status) {
    case kNoteOn:
    case kNoteOff:
      playNote({channel, first}, status == kNoteOn ? second : 0, played);
      break;
    case kKeyPressure:
      setKeyPressure(channel, first, second, played);
      break;
    case kController:
      setController(channel, first, second, played);
      break;
    case kProgram:
      played.program = first;
      break;
    case kChannelPressure:
      setControl(kPressureControl, channel, first / kMax, played);
      break;
    case kBend:
      setControl(kBendControl, channel, bendOf(first, second), played);
      break;
    default:
      break;
  }
  return played;
}

/// Plays a note; one with a channel of its own begins with the channel's last expression values.
void Keyboard::playNote(const Name& name, int velocity, Played& played) {
  key_pressures_.erase(name);
  if (velocity == 0) {
    return release(name, played.strokes);
  }
  const auto note = lineOf(name.second);
  const bool has_expression = note && zones_.isMember(name.first);
  if (!has_expression) {
    return press(name, velocity, played.strokes);
  }
  const Expression& now = expressions_[static_cast<std::size_t>(name.first)];
  moveFor(*note, kBendControl, now.bend, played);
  moveFor(*note, kSlideControl, now.slide, played);
  press(name, velocity, played.strokes);
  if (const auto down = down_.find(name); down != down_.end()) {
    down->second.pressure = now.pressure;
    followPressure(name.second, played.strokes);
  }
}

void Keyboard::setController(int channel, int number, int value, Played& played) {
  zones_.hear(channel, number, value);
  if (number == kResetControllers) {
    return resetControls(channel, played);
  }
  if (number == kAllSoundOff || number >= kAllNotesOff) {
    const Strokes released = releaseAll(now_s_);
    played.strokes.insert(played.strokes.end(), released.begin(), released.end());
    return;
  }
  if (number == kLocalControl) {
    return;
  }
  setPedal(number, value, played.strokes);
  setControl({Kind::kController, number}, channel, value / kMax, played);
}

/// Pedals come up, bend and pressure go home; wheels and volume stay where they are.
void Keyboard::resetControls(int channel, Played& played) {
  soft_ = 0.0;
  pedal_depth_ = 0.0;
  catchKeys(false, played.strokes);
  settleKept(played.strokes);
  key_pressures_.clear();
  setControl(kBendControl, channel, 0.0, played);
  setControl(kPressureControl, channel, 0.0, played);
}

/// Handles pressure of a single note; in a channel of its own it equals the channel's pressure.
void Keyboard::setKeyPressure(int channel, int note, int value, Played& played) {
  const Name name{channel, note};
  if (value > 0) {
    key_pressures_[name] = value;
  } else {
    key_pressures_.erase(name);
  }
  if (const auto down = down_.find(name); down != down_.end() && down->second.is_held) {
    down->second.pressure = value / kMax;
    followPressure(note, played.strokes);
  }
  if (!zones_.isMember(channel)) {
    int most = 0;
    for (const auto& [other, pressure] : key_pressures_) {
      most = std::max(most, pressure);
    }
    moveByMap(kPressureControl, most / kMax, played);
  }
}

void Keyboard::setControl(const Control& control, int channel, double share, Played& played) {
  if (zones_.isMember(channel) && isOfNotes(control)) {
    Expression& expression = expressions_[static_cast<std::size_t>(channel)];
    expression.bend = control == kBendControl ? share : expression.bend;
    expression.pressure = control == kPressureControl ? share : expression.pressure;
    expression.slide = control == kSlideControl ? share : expression.slide;
    return express(control, channel, share, played);
  }
  if (!zones_.isOn()) {
    express(control, std::nullopt, share, played);
  }
  moveByMap(control, share, played);
}

/// \param channel  of the notes that are meant; nothing: all
void Keyboard::express(const Control& control,
                       std::optional<int> channel,
                       double share,
                       Played& played) {
  for (auto& [name, down] : down_) {
    if (!down.is_held || (channel && name.first != *channel)) {
      continue;
    }
    if (control == kPressureControl) {
      down.pressure = share;
      followPressure(name.second, played.strokes);
    } else {
      moveFor(*lineOf(name.second), control, share, played);
    }
  }
}

/// Moves the targets of bend or slide of one note.
void Keyboard::moveFor(const Note& note, const Control& control, double share, Played& played) {
  if (control == kBendControl && note.line->bend) {
    move(*note.line->bend, note.number, control, share, played);
  } else if (control == kSlideControl && note.line->slide) {
    move(*note.line->slide, note.number, control, share, played);
  }
}

void Keyboard::moveByMap(const Control& control, double share, Played& played) {
  if (control.kind != Kind::kController || !hasAMeaning(control.number)) {
    played.learnt = learner_.hear(control, share);
  }
  if (const std::string* parameter = learner_.parameterOf(control)) {
    played.changes.push_back({*parameter, share, control.hasMiddle()});
    return;
  }
  for (const ControlLine& line : map_.controls) {
    if (line.control == control) {
      move(line.motion, std::nullopt, control, share, played);
    }
  }
}

/// \param number  of the one hand that moves; nothing: all do
void Keyboard::move(const Motion& motion,
                    std::optional<std::size_t> number,
                    const Control& control,
                    double share,
                    Played& played) {
  const bool is_bent = control.hasMiddle();
  if (!motion.parameter.empty()) {
    played.changes.push_back({motion.parameter, share, is_bent});
    return;
  }
  const double way = is_bent ? 0.5 * (share + 1.0) : share;
  const double target_m =
      way == 1.0 ? motion.to_m : motion.from_m + way * (motion.to_m - motion.from_m);
  const std::size_t count = motion.indices.size();
  const std::size_t first = number ? *number % count : 0;
  const std::size_t end = number ? first + 1 : count;
  for (std::size_t i = first; i < end; ++i) {
    const HandWays::Hand hand{motion.end_effector, motion.indices[i]};
    const auto placed = placed_.find(hand);
    double to_m = target_m;
    if (is_bent && placed != placed_.end()) {  // from where a note has put it
      const Placed& from = placed->second;
      const auto [least, most] = std::minmax(motion.from_m, motion.to_m);
      to_m = std::clamp(from.at_m + 0.5 * share * (motion.to_m - motion.from_m),
                        std::min(least, from.least_m), std::max(most, from.most_m));
    }
    ways_.follow(hand, to_m, motion.from_m, motion.speed, now_s_, played.strokes);
  }
}

}  // namespace ergotic::tgr
