// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ergotic/rt/audio_processor.hpp"

namespace ergotic::audio {

/// Latencies of a client at which signals begin and end, as a sound card; it passes no latency on.
struct JackTerminal {
  std::uint32_t input_latency_frames = 0;   ///< from our inputs to the world
  std::uint32_t input_latency_periods = 0;  ///< additional periods
  std::uint32_t output_latency_frames = 0;  ///< from the world to our outputs
};

constexpr const char* kPhysicalMidi = "physical";
constexpr const char* kNoMidi = "none";

struct JackConfig {
  std::string name = "ergotic";  ///< client name; JACK appends a number if it is taken
  std::string server;            ///< empty: $JACK_DEFAULT_SERVER, else `default`
  int inputs = 0;                ///< ports `in_1`... , 0...kMaxPorts
  int outputs = 0;               ///< ports `out_1`... , 0...kMaxPorts
  bool midi = false;             ///< a port `midi_in`
  /// MIDI ports to connect to `midi_in` whenever they appear: kPhysicalMidi, kNoMidi, or all MIDI
  /// ports with a name or an alias in which a regular expression (POSIX extended, no cases) is
  /// found.
  std::string midi_connect = kNoMidi;
  bool connect = false;              ///< out_i to the i-th physical playback port, at every start
  std::uint32_t latency_frames = 0;  ///< added between our inputs and outputs, declared to JACK
  std::vector<std::string>
      input_names;  ///< names of the ports, instead of `in_1`... ; empty: those
  std::vector<std::string> output_names;  ///< as above
  /// Exclusive peer of each port, kept connected as long as the host lives: a full name,
  /// `client:port`, or `physical N`, the N-th (1...) physical port. Empty: none.
  std::vector<std::string> input_peers, output_peers;
  std::optional<JackTerminal> terminal;
};

constexpr int kMaxPorts = 256;

/// Status of a JACK host at its last look, once a second.
struct JackStatus {
  bool running = false;  ///< periods are being processed
  bool freewheeling = false;
  double sample_rate_hz = 0.0;      ///< present or last sample rate of the server, 0: none yet
  std::uint32_t period_frames = 0;  ///< as above
  std::int64_t xruns = 0;           ///< number since construction
  std::int64_t starts = 0;          ///< number of times that periods began to flow
  std::int64_t looks = 0;           ///< number of looks at the server
  bool wired = false;               ///< all peers are connected, and no other ports on either side
  std::uint32_t input_latency_frames = 0;   ///< by JACK: largest age of arriving samples
  std::uint32_t output_latency_frames = 0;  ///< by JACK: largest delay of leaving samples
  std::string client;                       ///< name as JACK knows it, empty without a server
  std::string message;                      ///< error and its remedy, empty: none
};

/// A supervised JACK client: it is there whenever a server is.
///
/// A thread of its own looks for a server every second, starts none, connects when one appears, and
/// begins anew when it is killed, restarted or changes its period; the processor hears of it by
/// audioStarted and audioStopped. Between the two, `process` comes from JACK's real-time thread
/// with denormals flushed, `Period::start` in CLOCK_MONOTONIC and in the server's frame time
/// (continued beyond 32 bits; a new server counts anew). While the server freewheels audio counts
/// as stopped: an instrument in real time cannot follow. A server in asynchronous mode (without
/// `jackd -S`) that did not wait for us gives a late period the frame time of the next: that time
/// then comes twice. If audioStarted throws, the message is
/// kept and the start repeated later.
///
/// Wires to peers are mended within a second; `Period::wired` is false from the first period on
/// that misses one. A wire is one to one: a second source at an input of ours, or at what an output
/// of ours feeds, counts as a broken one; what others connected stays. `connect` passes over what
/// another host of this process is wired to.
///
/// Realtime: no. Thread: any, one at a time; the processor must outlive the host
class JackHost {
 public:
  /// Returns at once, server or not.
  /// \throws Exception if the number of ports, of their names or of their peers, or the name is out
  ///         of range
  JackHost(const JackConfig& config, rt::AudioProcessor& processor);
  ~JackHost();  ///< the processor is not called any more
  JackHost(const JackHost&) = delete;
  JackHost& operator=(const JackHost&) = delete;

  /// Thread: any
  JackStatus status() const;

  /// Repairs connections and looks for a server soon, not only within a second. Thread: any
  void look();

  /// Ends its client as if the server had gone, and begins anew with the next look: a fault on
  /// purpose. Thread: any
  void drop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ergotic::audio
