// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ergotic::tools {

/// What a MIDI file says to instruments, in order of time: messages of channels, no others.
struct Song {
  struct Message {
    double time_s = 0.0;  ///< since the beginning, by the tempos of the file
    std::array<std::uint8_t, 3> bytes{};
    int size = 0;  ///< of `bytes`
  };
  std::string file;
  std::vector<Message> messages;
  std::vector<std::string> warnings;  ///< what of the file cannot be understood
};

/// Reads a standard MIDI file of format 0 or 1, with all of its tracks.
/// \throws Exception naming file, place, value and what is allowed
Song readSong(const std::string& file);

}  // namespace ergotic::tools
