// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/midi_check.hpp"

#include <cstdint>
#include <cstdio>
#include <limits>

#include "ergotic/exception.hpp"

namespace ergotic::tools {
namespace {

constexpr std::size_t kHeaderBytes = 14;
constexpr std::size_t kChunkHeaderBytes = 8;

std::string hexOf(unsigned byte) {
  char text[8];
  std::snprintf(text, sizeof(text), "0x%02x", byte);
  return text;
}

/// Goes through the chunks of a file, and through the events of its tracks.
class MidiFileCheck {
 public:
  MidiFileCheck(const std::string& bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  void run() {
    readHeader();
    for (at_ = kHeaderBytes; at_ < bytes_.size(); at_ = end_) {
      readChunk();
    }
    if (tracks_ != expected_tracks_) {
      fail(bytes_.size(), "the file has " + std::to_string(tracks_) + " tracks, allowed: " +
                              std::to_string(expected_tracks_) + ", as its header says");
    }
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& what) const {
    throw Exception(file_ + ": byte " + std::to_string(at) + ": error: " + what);
  }

  unsigned byteAt(std::size_t at) const { return static_cast<std::uint8_t>(bytes_[at]); }
  std::uint32_t number(std::size_t at, int bytes) const {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) {
      value = value << 8U | byteAt(at + static_cast<std::size_t>(i));
    }
    return value;
  }

  void readHeader() {
    if (bytes_.size() < kHeaderBytes || bytes_.compare(0, 4, "MThd") != 0) {
      fail(0, "this is not a MIDI file, allowed: a standard MIDI file, which begins with MThd");
    }
    if (const std::uint32_t length = number(4, 4); length != 6) {
      fail(4, "the length of the header is " + std::to_string(length) + ", allowed: 6");
    }
    if (const std::uint32_t format = number(8, 2); format > 1) {
      fail(8, "the format is " + std::to_string(format) + ", allowed: 0 and 1");
    }
    expected_tracks_ = number(10, 2);
    if (number(8, 2) == 0 && expected_tracks_ != 1) {
      fail(10,
           "a file of format 0 has " + std::to_string(expected_tracks_) + " tracks, allowed: 1");
    }
    const std::uint32_t division = number(12, 2);
    constexpr std::uint32_t kFramesPerSecond = 0x8000;
    if (division == 0 || division >= kFramesPerSecond) {
      fail(12, "the division is " + std::to_string(division) +
                   ", allowed: 1...32767 pulses of a quarter, and no time code");
    }
  }

  void readChunk() {
    const std::size_t begin = at_;
    const std::size_t left = bytes_.size() - begin;
    const std::uint32_t length = left < kChunkHeaderBytes ? 0 : number(begin + 4, 4);
    if (left < kChunkHeaderBytes || length > left - kChunkHeaderBytes) {
      fail(begin, "the file breaks off within a chunk of " + std::to_string(length) + " bytes");
    }
    at_ = begin + kChunkHeaderBytes;
    end_ = at_ + length;
    if (bytes_.compare(begin, 4, "MTrk") == 0) {
      ++tracks_;
      readTrack();
    }
  }

  void readTrack() {
    status_ = 0;
    pulses_ = 0;
    while (!readEvent()) {
    }
    if (at_ != end_) {
      fail(at_, "the track goes on after its end, allowed: nothing");
    }
  }

  unsigned next() {
    if (at_ >= end_) {
      fail(at_, "the track breaks off, allowed: a track that ends with an end of track, ff 2f 00");
    }
    return byteAt(at_++);
  }

  /// A number of seven bits to a byte.
  std::uint32_t nextNumber() {
    constexpr int kMaxBytes = 4;
    const std::size_t begin = at_;
    std::uint32_t value = 0;
    for (int i = 0; i < kMaxBytes; ++i) {
      const unsigned byte = next();
      value = value << 7U | (byte & 0x7fU);
      if (byte < 0x80U) {
        return value;
      }
    }
    fail(begin, "a number has more than 4 bytes");
  }

  void skip(std::uint32_t count) {
    if (count > end_ - at_) {
      fail(at_, "the track breaks off within an event of " + std::to_string(count) + " bytes");
    }
    at_ += count;
  }

  /// \return true at the end of the track
  bool readEvent() {
    const std::size_t begin = at_;
    pulses_ += nextNumber();
    if (pulses_ > std::numeric_limits<std::int32_t>::max()) {
      fail(begin, "an event is at pulse " + std::to_string(pulses_) + ", allowed: 0...2147483647");
    }
    const std::size_t event = at_;
    const unsigned first = next();
    switch (first) {
      case 0xf0:
        status_ = 0;
        skip(nextNumber());
        return false;
      case 0xff:
        status_ = 0;
        return readMeta();
      default:
        readMessage(event, first);
        return false;
    }
  }

  /// \return true at the end of the track
  bool readMeta() {
    enum Type : std::uint8_t { kEndOfTrack = 0x2f, kTempo = 0x51, kMeter = 0x58 };
    const std::size_t begin = at_;
    const unsigned type = next();
    const std::uint32_t length = nextNumber();
    const auto require = [&](unsigned of_type, std::uint32_t bytes, const char* what) {
      if (type == of_type && length != bytes) {
        fail(begin, std::string(what) + " has " + std::to_string(length) +
                        " bytes, allowed: " + std::to_string(bytes));
      }
    };
    require(kEndOfTrack, 0, "an end of track");
    require(kTempo, 3, "a tempo");
    require(kMeter, 4, "a time signature");
    if (type >= 0x80U) {
      fail(begin, "a meta event is of the type " + hexOf(type) + ", allowed: 0x00...0x7f");
    }
    skip(length);
    if (type == kTempo && number(at_ - 3, 3) == 0) {
      fail(begin, "a tempo is 0 us for a quarter, allowed: 1 us or more");
    }
    return type == kEndOfTrack;
  }

  void readMessage(std::size_t event, unsigned first) {
    constexpr unsigned kFirstStatus = 0x80;
    constexpr unsigned kFirstOfSystem = 0xf0;
    const bool has_status = first >= kFirstStatus;
    status_ = has_status ? first : status_;
    if (status_ < kFirstStatus || status_ >= kFirstOfSystem) {
      fail(event, "an event begins with " + hexOf(first) +
                      ", allowed: 0x80...0xf0, 0xff, or less after a message");
    }
    const unsigned kind = status_ & 0xf0U;
    const int length = kind == 0xc0U || kind == 0xd0U ? 1 : 2;
    for (int i = has_status ? 0 : 1; i < length; ++i) {
      const std::size_t at = at_;
      if (const unsigned byte = next(); byte >= kFirstStatus) {
        fail(at, "a byte of a message is " + hexOf(byte) + ", allowed: 0x00...0x7f");
      }
    }
  }

  const std::string& bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t end_ = 0;  // of the chunk
  std::uint32_t expected_tracks_ = 0;
  std::uint32_t tracks_ = 0;
  unsigned status_ = 0;       // of the last message; 0: none that may go on
  std::uint64_t pulses_ = 0;  // since the beginning of the track
};

}  // namespace

void checkMidiFile(const std::string& bytes, const std::string& file) {
  MidiFileCheck(bytes, file).run();
}

}  // namespace ergotic::tools
