// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/station/station.hpp"

namespace ergotic::station {

struct TimerOptions;

/// Source of the ticks of a station. Realtime: no. Thread: setup
class TickSource {
 public:
  virtual ~TickSource() = default;
  /// Ends after the present tick, with zero force sent. Idempotent.
  virtual void stop() noexcept = 0;
  virtual bool isRunning() const noexcept = 0;
  /// Warnings: what the system refused to `start`, and what to do about it.
  virtual const std::vector<std::string>& warnings() const noexcept = 0;
};

/// Starts a DeviceSource if the station's device has a clock of its own, else a TimerSource.
/// \param bridge   may be null: no audio host, ever. Both must outlive the source.
/// \param options  of the timer; a device's clock takes `lock_memory`, its thread is its own
/// \throws Exception if an option is outside its range
std::unique_ptr<TickSource> startTicks(Station& station,
                                       AudioBridge* bridge,
                                       const TimerOptions& options);

}  // namespace ergotic::station
