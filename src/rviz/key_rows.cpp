// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/key_rows.hpp"

#include <algorithm>

namespace ergotic::panel {
namespace {

/// White keys from left to right in a row, black ones in the row above it.
struct Row {
  std::uint32_t first_white;  // scan code
  std::uint32_t keys;
  std::uint32_t first_black;  // scan code of the key between the first two white ones
  int first_note;
};
constexpr Row kRows[] = {{52, 10, 39, 48},   // Z X C V B N M , . /  and  S D . G H J . L ;
                         {24, 10, 11, 60}};  // Q W E R T Y U I O P  and  2 3 . 5 6 7 . 9 0
constexpr int kWhite[] = {0, 2, 4, 5, 7, 9, 11};
constexpr bool kHasBlack[] = {true, true, false, true, true, true, false};
constexpr std::uint32_t kOctave = 7;  // white keys
constexpr int kSemitones = 12;        // an octave
constexpr int kMostOctaves = 4;       // keeps all notes within 0 to 127

int whiteNote(const Row& row, std::uint32_t place) {
  return row.first_note + kSemitones * static_cast<int>(place / kOctave) + kWhite[place % kOctave];
}

}  // namespace

std::optional<int> noteOfKey(std::uint32_t scan_code) {
  for (const Row& row : kRows) {
    if (const std::uint32_t place = scan_code - row.first_white; place < row.keys) {
      return whiteNote(row, place);
    }
    const std::uint32_t place = scan_code - row.first_black;
    if (place < row.keys - 1 && kHasBlack[place % kOctave]) {
      return whiteNote(row, place) + 1;
    }
  }
  return std::nullopt;
}

std::optional<int> KeyRows::press(std::uint32_t scan_code) {
  const auto place = noteOfKey(scan_code);
  if (!place) {
    return std::nullopt;
  }
  const int note = *place + kSemitones * octave_;
  const auto found = std::find_if(held_.begin(), held_.end(),
                                  [note](const Held& held) { return held.note == note; });
  if (found == held_.end()) {
    held_.push_back({scan_code, note, true});
    return note;
  }
  if (found->is_pressed) {
    return std::nullopt;
  }
  *found = {scan_code, note, true};
  return note;
}

std::optional<int> KeyRows::release(std::uint32_t scan_code) {
  const auto found = std::find_if(held_.begin(), held_.end(), [scan_code](const Held& held) {
    return held.scan_code == scan_code && held.is_pressed;
  });
  if (found == held_.end()) {
    return std::nullopt;
  }
  if (is_pedal_down_) {
    found->is_pressed = false;
    return std::nullopt;
  }
  const int note = found->note;
  held_.erase(found);
  return note;
}

std::vector<int> KeyRows::setPedal(bool is_down) {
  is_pedal_down_ = is_down;
  std::vector<int> ended;
  if (!is_down) {
    const auto kept = std::stable_partition(held_.begin(), held_.end(),
                                            [](const Held& held) { return held.is_pressed; });
    for (auto held = kept; held != held_.end(); ++held) {
      ended.push_back(held->note);
    }
    held_.erase(kept, held_.end());
  }
  return ended;
}

void KeyRows::shift(int octaves) {
  octave_ = std::clamp(octave_ + octaves, -kMostOctaves, kMostOctaves);
}

int KeyRows::lowest() const {
  return kRows[0].first_note + kSemitones * octave_;
}

std::vector<int> KeyRows::down() const {
  std::vector<int> notes;
  for (const Held& held : held_) {
    notes.push_back(held.note);
  }
  return notes;
}

std::vector<int> KeyRows::releaseAll() {
  std::vector<int> notes = down();
  held_.clear();
  is_pedal_down_ = false;
  return notes;
}

}  // namespace ergotic::panel
