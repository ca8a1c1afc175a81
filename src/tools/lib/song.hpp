// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ergotic::tools {

/// Channel messages of a MIDI file, in order of time.
struct Song {
  struct Message {
    double time_s = 0.0;  ///< since the beginning, by the tempos of the file
    std::array<std::uint8_t, 3> bytes{};
    int size = 0;  ///< size of `bytes`
  };
  std::string file;
  std::vector<Message> messages;
  std::vector<std::string> warnings;  ///< parts of the file that cannot be interpreted
};

/// Reads a standard MIDI file of format 0 or 1, with all of its tracks.
/// \throws Exception naming file, place, value and what is allowed
Song readSong(const std::string& file);

}  // namespace ergotic::tools
