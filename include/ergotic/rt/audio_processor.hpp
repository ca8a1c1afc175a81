// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "ergotic/rt/clock.hpp"

namespace ergotic::rt {

/// A MIDI message that came in with a period.
struct MidiMessage {
  std::uint32_t offset = 0;  ///< frames after the start of the period; see Period::midi
  std::uint8_t size = 0;     ///< bytes, 1...3: longer messages (system exclusive) are left out
  std::array<std::uint8_t, 3> bytes{};
};

/// One period of an audio host; JACK is not visible outside its implementation.
///
/// The host calls `AudioProcessor::process` from its real-time thread with spans of float channels,
/// and reports when it starts and stops.
struct Period {
  std::uint32_t nframes = 0;
  FrameTime start;                       ///< frame count and time of the first frame of the period
  const float* const* inputs = nullptr;  ///< [input channels][nframes]
  float* const* outputs = nullptr;       ///< [output channels][nframes], to be filled wholly
  int input_channels = 0;
  int output_channels = 0;
  /// [midi_messages] in order. They happened in the period before, at the same offsets.
  const MidiMessage* midi = nullptr;
  int midi_messages = 0;
  bool wired = true;  ///< all channels are connected as requested
};

class AudioProcessor {
 public:
  virtual ~AudioProcessor() = default;
  /// The host starts or restarts: rates and sizes hold until the next call. Thread: host, not RT
  virtual void audioStarted(double sample_rate_hz, std::uint32_t period_frames) = 0;
  /// The host is gone. May come from any thread; must not block.
  virtual void audioStopped() noexcept = 0;
  /// Realtime: yes. Thread: host RT
  virtual void process(const Period& period) noexcept = 0;
  /// The host lost a period (xrun). Must not block.
  virtual void xrun() noexcept = 0;
};

}  // namespace ergotic::rt
