// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <jack/jack.h>

namespace ergotic::test {

/// A message of a MIDI file, and when it is due.
struct MelodyEvent {
  double time_s = 0.0;  ///< since the beginning of the file
  std::vector<std::uint8_t> bytes;

  bool isNoteOn() const { return bytes.size() == 3 && (bytes[0] & 0xf0U) == 0x90 && bytes[2] > 0; }
  int note() const { return bytes.at(1); }
};

/// Writes standard MIDI files track by track. Times are pulses, kPulses to a quarter.
class MelodyWriter {
 public:
  static constexpr int kPulses = 480;

  /// \param track  1, 2, ...
  void add(int track, int pulse, std::vector<std::uint8_t> bytes);
  void addNote(int track, int pulse, int length, std::uint8_t note, std::uint8_t velocity);
  /// From there on a quarter takes so long.
  void addTempo(int pulse, std::uint32_t quarter_us);
  /// \throws std::runtime_error if libsmf does not write it
  void save(const std::string& file) const;

 private:
  std::map<int, std::multimap<int, std::vector<std::uint8_t>>> tracks_;
};

/// What a MIDI file says to instruments, in order of time.
/// \throws std::runtime_error if libsmf does not read it
std::vector<MelodyEvent> readMelody(const std::string& file);

/// A JACK client that plays a melody from its MIDI port `out`, to the frame.
class MelodyPlayer {
 public:
  /// \param name  of the client. \throws std::runtime_error without the server
  MelodyPlayer(const std::string& name, const std::string& server);
  ~MelodyPlayer();
  MelodyPlayer(const MelodyPlayer&) = delete;
  MelodyPlayer& operator=(const MelodyPlayer&) = delete;

  void connectTo(const std::string& port) const;
  /// \return [events] frames of JACK at which they are sent; the first a little later than now
  /// \pre no other melody plays
  std::vector<std::int64_t> play(const std::vector<MelodyEvent>& melody);
  /// When an event was handed to JACK, CLOCK_MONOTONIC. \pre isOver
  std::int64_t sentNs(std::size_t event) const { return sent_ns_[event]; }
  /// How late periods of JACK began between these times of CLOCK_MONOTONIC, by JACK's own clock,
  /// at most, ns.
  std::int64_t mostLateNs(std::int64_t from_ns, std::int64_t to_ns) const;
  bool isOver() const { return !plays_.load(std::memory_order_acquire); }

 private:
  struct Period {
    std::int64_t time_ns = 0;  // CLOCK_MONOTONIC
    std::int64_t late_ns = 0;
  };
  int send(jack_nframes_t frames);
  std::int64_t logPeriod(std::int64_t first_frame);

  jack_client_t* client_;
  jack_port_t* port_;
  std::vector<MelodyEvent> melody_;
  std::vector<std::int64_t> frames_;
  std::vector<std::int64_t> sent_ns_;
  std::size_t next_ = 0;
  std::atomic<bool> plays_{false};
  std::vector<Period> log_ = std::vector<Period>(20'000);
  std::atomic<std::size_t> periods_{0};
};

/// A JACK client that keeps what it hears, one channel for each port that it listens to.
class MelodyListener {
 public:
  /// \param seconds  that it keeps at most. \throws std::runtime_error without the server
  MelodyListener(const std::string& server, const std::vector<std::string>& ports, double seconds);
  ~MelodyListener();
  MelodyListener(const MelodyListener&) = delete;
  MelodyListener& operator=(const MelodyListener&) = delete;

  /// The first frame of JACK from one on, and before another, at which a channel is louder; -1 if
  /// there is none.
  std::int64_t firstLouder(std::size_t channel,
                           float level,
                           std::int64_t from,
                           std::int64_t before) const;

 private:
  int hear(jack_nframes_t frames);

  jack_client_t* client_;
  std::vector<jack_port_t*> ports_;
  std::vector<std::vector<float>> sound_;  // [ports][frames]
  std::int64_t first_ = -1;                // frame of JACK
  std::atomic<std::int64_t> heard_{0};     // frames
};

}  // namespace ergotic::test
