// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/keyboard.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {
namespace {

constexpr int kNotes = 128;
constexpr int kHalf = 64;  // a pedal is down from there on
constexpr double kMost = 127.0;

enum Status : std::uint8_t { kNoteOff = 0x80, kNoteOn = 0x90, kController = 0xb0 };
enum Controller : std::uint8_t { kSustain = 64, kAllSoundOff = 120, kAllNotesOff = 123 };

double speedOf(const KeyLine& line, int velocity) {
  return line.slowest * std::pow(line.fastest / line.slowest, (velocity - 1) / (kMost - 1.0));
}

}  // namespace

std::vector<Stroke> Keyboard::use(PlayMap map) {
  std::vector<Stroke> released = releaseAll();
  map_ = std::move(map);
  return released;
}

std::optional<Keyboard::Key> Keyboard::keyOf(int note) const {
  const int sounding = note + map_.transpose;
  for (const KeyLine& line : map_.keys) {
    if (sounding >= line.first_note && sounding <= line.last_note) {
      const auto number = static_cast<std::size_t>(sounding - line.first_note);
      return Key{&line, line.indices[number % line.indices.size()]};
    }
  }
  return std::nullopt;
}

bool Keyboard::isDown(const Key& key) const {
  return std::any_of(down_.begin(), down_.end(), [&](const auto& other) {
    const auto others = keyOf(other.first);
    return others->index == key.index && others->line->end_effector == key.line->end_effector;
  });
}

Stroke Keyboard::stroke(const Key& key, double target_m, double speed) {
  const double way = std::abs(key.line->to_m - key.line->from_m);
  return {key.line->end_effector, key.index, target_m,
          std::min(HandMove::kPeakOfMean * way / speed, HandMove::kMostGlideS), 0.0};
}

Keyboard::Played Keyboard::play(const std::uint8_t* bytes, int size) {
  if (size < 3 || bytes[1] >= kNotes || bytes[2] >= kNotes) {
    return {};
  }
  constexpr std::uint8_t kWithoutChannel = 0xf0;
  const int value = bytes[2];
  switch (bytes[0] & kWithoutChannel) {
    case kNoteOn:
      return {note(bytes[1], value), "", 0.0};
    case kNoteOff:
      return {note(bytes[1], 0), "", 0.0};
    case kController:
      break;
    default:
      return {};
  }
  if (bytes[1] == kSustain) {
    return {setPedal(value >= kHalf), "", 0.0};
  }
  if (bytes[1] == kAllSoundOff || bytes[1] == kAllNotesOff) {
    return {releaseAll(), "", 0.0};
  }
  for (const ControllerLine& line : map_.controllers) {
    if (line.controller == bytes[1]) {
      return {{}, line.parameter, value / kMost};
    }
  }
  return {};
}

std::vector<Stroke> Keyboard::note(int note, int velocity) {
  return velocity > 0 ? press(note, velocity) : release(note);
}

std::vector<Stroke> Keyboard::press(int note, int velocity) {
  const auto key = keyOf(note);
  if (!key) {
    return {};
  }
  Stroke there = stroke(*key, key->line->to_m, speedOf(*key->line, velocity));
  if (key->line->strikes) {
    Stroke back = stroke(*key, key->line->from_m, key->line->back);
    back.after_s = there.glide_s;
    return {there, back};
  }
  std::vector<Stroke> strokes;
  if (isDown(*key)) {  // it has to come up before it can be pressed again
    strokes.push_back(stroke(*key, key->line->from_m, key->line->fastest));
    there.after_s = strokes.back().glide_s;
  }
  strokes.push_back(there);
  down_[note] = false;
  return strokes;
}

std::vector<Stroke> Keyboard::release(int note) {
  const auto found = down_.find(note);
  if (found == down_.end()) {
    return {};
  }
  if (pedal_) {
    found->second = true;
    return {};
  }
  down_.erase(found);
  const Key key = *keyOf(note);
  if (isDown(key)) {
    return {};  // by another note
  }
  return {stroke(key, key.line->from_m, key.line->back)};
}

std::vector<Stroke> Keyboard::setPedal(bool is_down) {
  pedal_ = is_down;
  std::vector<Stroke> strokes;
  const std::map<int, bool> down = down_;
  for (const auto& [note, is_kept] : down) {
    if (!is_down && is_kept) {
      const std::vector<Stroke> back = release(note);
      strokes.insert(strokes.end(), back.begin(), back.end());
    }
  }
  return strokes;
}

std::vector<Stroke> Keyboard::releaseAll() {
  for (auto& [note, is_kept] : down_) {
    is_kept = true;
  }
  return setPedal(false);
}

}  // namespace ergotic::tgr
