// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "ergotic/rt/clock.hpp"

namespace ergotic::rt {

/// What an audio host offers to the engine: nothing of JACK is visible past this file.
///
/// The host calls `AudioProcessor::process` from its real-time thread with spans of float
/// channels, and tells it when it comes and goes.
struct Period {
  std::uint32_t nframes = 0;
  FrameTime start;                       ///< frame count and time of the first frame of the period
  const float* const* inputs = nullptr;  ///< [input channels][nframes]
  float* const* outputs = nullptr;       ///< [output channels][nframes], to be filled wholly
  int input_channels = 0;
  int output_channels = 0;
  bool wired = true;  ///< all channels are connected as the host was told to connect them
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
