// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/key_rows.hpp"

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

int whiteNote(const Row& row, std::uint32_t place) {
  return row.first_note + 12 * static_cast<int>(place / kOctave) + kWhite[place % kOctave];
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

}  // namespace ergotic::panel
