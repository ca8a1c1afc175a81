// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "audio/semaphore.hpp"
#include "ergotic/audio/jack_client.hpp"
#include "ergotic/rt/audio_processor.hpp"

namespace ergotic::audio {

/// A session of a JACK client: from the start of a server until it goes.
///
/// The order of calls is constructor, activate, then any number of pause and resume.
/// Realtime: no. Thread: one
class JackSession {
 public:
  /// \param wake  posted when `isLost` or `takeChange` has news; shared, for libjack
  ///              may call back even after the session
  /// \throws DeviceError if there is no server or it takes no client
  JackSession(const std::string& server, const std::string& name, std::shared_ptr<Semaphore> wake);
  ~JackSession();  ///< the processor is not called any more; gives up on libjack after a while
  JackSession(const JackSession&) = delete;
  JackSession& operator=(const JackSession&) = delete;

  /// Callbacks begin, silent until `resume`; then the ports appear. Ports, their names, latencies
  /// and peers are those of the configuration. \throws DeviceError
  void activate(const JackConfig& config, rt::AudioProcessor& processor);

  /// audioStarted, then blocks flow. \throws what audioStarted throws; stays paused then
  void resume();
  /// Blocks stop, then audioStopped. No effect while paused.
  void pause() noexcept;
  bool isFlowing() const noexcept { return flowing_; }

  /// CLOCK_MONOTONIC of the last period, ns: a server that is stopped says nothing. Thread: any
  std::shared_ptr<const std::atomic<std::int64_t>> lastPeriodNs() const;

  bool isLost() const noexcept;          ///< the server went away or threw us out
  bool isFreewheeling() const noexcept;  ///< state of the server
  /// Whether period or freewheeling changed since the last call.
  bool takeChange() noexcept;
  std::int64_t takeXruns() noexcept;  ///< number since the last call

  std::string clientName() const;
  double sampleRate() const noexcept;           ///< Hz
  std::uint32_t periodFrames() const noexcept;  ///< at the last resume

  /// Full names of audio ports that give sound and match the regular expression (POSIX extended),
  /// or whose name is `exact`.
  std::vector<std::string> findSources(const std::string& regex) const;
  bool isSource(const std::string& exact) const;
  /// \param input  index of our port. \throws DeviceError
  void connectInput(int input, const std::string& source);
  /// Whether anything is connected to one of our inputs: what was ends with its client.
  bool isConnected(int input) const;
  /// out_i to the i-th physical playback port, unless another output of this process is wired to
  /// it; what is connected there stays.
  void connectToPlayback();
  /// MIDI sources that have appeared to `midi_in`, if there is one.
  void connectMidi();
  /// Connects the ports with their peers as far as they are not. No effect without peers.
  /// \throws DeviceError saying which wire is missing or shared; blocks are not `wired` then
  void mendWires();
  bool isWired() const noexcept;
  /// Largest latencies of our ports by JACK, frames.
  std::uint32_t inputLatency() const noexcept;
  std::uint32_t outputLatency() const noexcept;

 private:
  struct Core;
  std::shared_ptr<Core> core_;
  bool flowing_ = false;
};

}  // namespace ergotic::audio
