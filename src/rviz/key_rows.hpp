// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace ergotic::panel {

/// The note of a key of the computer's keyboard, MIDI numbers: two rows are two octaves of a piano,
/// the row of Z from C3 (48) and the row of Q from C4 (60) on, with the black keys in the rows
/// above.
///
/// \param scan_code  of X11 (evdev plus 8): the place of the key, whatever its letter is
std::optional<int> noteOfKey(std::uint32_t scan_code);

/// Notes that are held by keys of a computer keyboard, or by its sustain pedal. Thread: of the
/// window
class KeyRows {
 public:
  /// \return the note that begins, if no key holds it already
  std::optional<int> press(std::uint32_t scan_code);
  /// \return the note that ends, if the key held one and the pedal does not keep it
  std::optional<int> release(std::uint32_t scan_code);
  /// \return the notes that end as the pedal comes up
  std::vector<int> setPedal(bool is_down);
  /// Moves both rows, within four octaves to either side; notes that are held stay.
  void shift(int octaves);
  /// The note of Z.
  int lowest() const;
  /// All that are held.
  std::vector<int> down() const;
  /// \return all notes that were held. The pedal is up then.
  std::vector<int> releaseAll();

 private:
  struct Held {
    std::uint32_t scan_code;
    int note;
    bool is_pressed;  // else the pedal keeps it
  };

  std::vector<Held> held_;
  bool is_pedal_down_ = false;
  int octave_ = 0;
};

}  // namespace ergotic::panel
