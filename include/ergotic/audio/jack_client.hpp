// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ergotic/rt/block_io.hpp"

namespace ergotic::audio {

struct JackConfig {
  std::string name = "ergotic";      ///< of the client; JACK appends a number if it is taken
  std::string server;                ///< empty: $JACK_DEFAULT_SERVER, else `default`
  int inputs = 0;                    ///< ports `in_1`... , 0...kMaxPorts
  int outputs = 0;                   ///< ports `out_1`... , 0...kMaxPorts
  bool connect = false;              ///< out_i to the i-th physical playback port, at every start
  std::uint32_t latency_frames = 0;  ///< added between our inputs and outputs, declared to JACK
};

constexpr int kMaxPorts = 256;

/// What a JACK host has to say about itself, as of its last look, once a second.
struct JackStatus {
  bool running = false;  ///< blocks are being processed
  bool freewheeling = false;
  double sample_rate_hz = 0.0;      ///< of the server now or last seen, 0: none yet
  std::uint32_t period_frames = 0;  ///< as above
  std::int64_t xruns = 0;           ///< since construction
  std::int64_t starts = 0;          ///< how often blocks began to flow
  std::string client;               ///< name as JACK knows it, empty without a server
  std::string message;              ///< what is wrong and what is done about it, empty: nothing
};

/// A supervised JACK client: it is there whenever a server is.
///
/// A thread of its own looks for a server every second, starts none, connects when one appears, and
/// begins anew when it is killed, restarted or changes its period; the processor hears of it by
/// audioStarted and audioStopped. Between the two, `process` comes from JACK's real-time thread
/// with denormals flushed, `Block::start` in CLOCK_MONOTONIC and in the server's frame time
/// (continued beyond 32 bits; a new server counts anew). While the server freewheels audio counts
/// as stopped: an instrument in real time cannot follow. A server in asynchronous mode (without
/// `jackd -S`) that did not wait for us gives a late block the frame time of the next: that time
/// then comes twice. If audioStarted throws, the message is
/// kept and the start repeated later.
///
/// Realtime: no. Thread: any, one at a time; the processor must outlive the host
class JackHost {
 public:
  /// Returns at once, server or not.
  /// \throws Exception if the number of ports or the name is out of range
  JackHost(const JackConfig& config, rt::BlockProcessor& processor);
  ~JackHost();  ///< the processor is not called any more
  JackHost(const JackHost&) = delete;
  JackHost& operator=(const JackHost&) = delete;

  /// Thread: any
  JackStatus status() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ergotic::audio
