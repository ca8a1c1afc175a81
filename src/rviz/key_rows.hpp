// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace ergotic::panel {

/// The note of a key of the computer's keyboard, MIDI numbers: two rows are two octaves of a piano,
/// the row of Z from C3 (48) and the row of Q from C4 (60) on, with the black keys in the rows
/// above.
///
/// \param scan_code  of X11 (evdev plus 8): the place of the key, whatever its letter is
std::optional<int> noteOfKey(std::uint32_t scan_code);

/// Notes that are held by keys of a computer keyboard. Thread: of the window
class KeyRows {
 public:
  /// \return the note that begins, if it is one that is not down already
  std::optional<int> press(std::uint32_t scan_code) {
    const auto note = noteOfKey(scan_code);
    if (!note || std::find(down_.begin(), down_.end(), *note) != down_.end()) {
      return std::nullopt;
    }
    down_.push_back(*note);
    return note;
  }
  /// \return the note that ends, if it was down
  std::optional<int> release(std::uint32_t scan_code) {
    const auto note = noteOfKey(scan_code);
    const auto found = note ? std::find(down_.begin(), down_.end(), *note) : down_.end();
    if (found == down_.end()) {
      return std::nullopt;
    }
    down_.erase(found);
    return note;
  }
  const std::vector<int>& down() const { return down_; }
  /// \return all notes that were down
  std::vector<int> releaseAll() { return std::exchange(down_, {}); }

 private:
  std::vector<int> down_;
};

}  // namespace ergotic::panel
