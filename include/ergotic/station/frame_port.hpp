// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "ergotic/station/messages.hpp"

namespace ergotic::station {

/// Status of the audio side, as the station's snapshot reports it.
struct AudioStatus {
  bool running = false;       ///< a host takes frames
  bool clock_locked = false;  ///< the frame clock of the host is known
  std::int64_t underruns = 0;
  std::int64_t underrun_frames = 0;
  std::int64_t xruns = 0;
  std::int64_t dropped_records = 0;  ///< losses that could not be reported as events
};

/// Interface through which a tick sends and receives audio frames. Realtime: yes. Thread: tick
class FramePort {
 public:
  virtual ~FramePort() = default;
  /// \param frames  [nframes][output channels of the station], station frame `first` onwards
  virtual void push(std::int64_t first, const float* frames, int nframes) noexcept = 0;
  /// Fills [nframes][input channels of the station]; silence where there is none.
  /// \return false if all of it is silence
  virtual bool pull(std::int64_t first, float* frames, int nframes) noexcept = 0;
  /// Takes the next audio event since the last call; the station publishes it among its own events.
  /// \return false if there is no more. A port without a host has no events.
  virtual bool popEvent(Event& /*event*/) noexcept { return false; }
  virtual AudioStatus status() const noexcept { return {}; }
};

}  // namespace ergotic::station
