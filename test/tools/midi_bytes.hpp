// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ergotic::test {

/// A standard MIDI file, written byte by byte. Times are pulses.
class MidiBytes {
 public:
  using Bytes = std::vector<std::uint8_t>;
  static constexpr std::uint32_t kPulses = 480;  ///< of a quarter

  MidiBytes& add(int track, std::uint32_t pulse, Bytes bytes) {
    tracks_[track].emplace(pulse, std::move(bytes));
    return *this;
  }
  MidiBytes& tempo(int track, std::uint32_t pulse, std::uint32_t quarter_us) {
    Bytes bytes{0xff, 0x51, 3};
    append(quarter_us, 3, bytes);
    return add(track, pulse, bytes);
  }

  /// \return the bytes of a file of format 0 if there is one track, else of format 1
  std::string text() const {
    Bytes file{'M', 'T', 'h', 'd', 0,
               0,   0,   6,   0,   tracks_.size() > 1 ? std::uint8_t{1} : std::uint8_t{0}};
    append(static_cast<std::uint32_t>(tracks_.size()), 2, file);
    append(kPulses, 2, file);
    for (const auto& [number, events] : tracks_) {
      Bytes track;
      std::uint32_t now = 0;
      for (const auto& [pulse, bytes] : events) {
        appendDelta(pulse - now, track);
        track.insert(track.end(), bytes.begin(), bytes.end());
        now = pulse;
      }
      const Bytes end_of_track{0, 0xff, 0x2f, 0};
      track.insert(track.end(), end_of_track.begin(), end_of_track.end());
      file.insert(file.end(), {'M', 'T', 'r', 'k'});
      append(static_cast<std::uint32_t>(track.size()), 4, file);
      file.insert(file.end(), track.begin(), track.end());
    }
    return {file.begin(), file.end()};
  }

 private:
  static void append(std::uint32_t value, unsigned bytes, Bytes& to) {
    for (unsigned i = bytes; i-- > 0;) {
      to.push_back(static_cast<std::uint8_t>(value >> 8U * i & 0xffU));
    }
  }
  static void appendDelta(std::uint32_t value, Bytes& to) {
    for (unsigned i = 4; i-- > 1;) {
      if (const std::uint32_t high = value >> 7U * i; high > 0) {
        to.push_back(static_cast<std::uint8_t>(0x80U | (high & 0x7fU)));
      }
    }
    to.push_back(static_cast<std::uint8_t>(value & 0x7fU));
  }

  std::map<int, std::multimap<std::uint32_t, Bytes>> tracks_;
};

}  // namespace ergotic::test
