// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/station/station.hpp"
#include "ergotic/station/tick_source.hpp"
#include "ergotic/tgr/device_clock.hpp"

namespace ergotic::station {

/// Ticks a station when the clock of its device says so, in the device's real-time thread.
///
/// Sound stays in step only if device and audio host share a clock, as two clients of one JACK
/// server do: station frames then belong to host frames as they do with a timer. No ticks, no
/// sound: what stops the device stops the model.
class DeviceSource final : public TickSource, public tgr::TickTarget {
 public:
  /// \param bridge  may be null: no audio host, ever. Both must outlive the source.
  /// \throws Exception if the device has no clock of its own. Realtime: no. Thread: setup
  DeviceSource(Station& station, AudioBridge* bridge);
  ~DeviceSource() override { stop(); }
  DeviceSource(const DeviceSource&) = delete;
  DeviceSource& operator=(const DeviceSource&) = delete;

  /// \param lock_memory  of the whole process; what the system refuses becomes a warning
  /// \pre not running. Realtime: no. Thread: setup
  void start(bool lock_memory);
  void stop() noexcept override;
  bool isRunning() const noexcept override { return running_; }
  const std::vector<std::string>& warnings() const noexcept override { return warnings_; }

  ERGOTIC_REALTIME void tick(std::int64_t late_ns) noexcept override;
  ERGOTIC_REALTIME void missed(std::int64_t ticks, std::int64_t stall_ns) noexcept override;

 private:
  void follow(std::int64_t due_ns) noexcept;

  Station& station_;
  AudioBridge* bridge_;
  tgr::DeviceClock& clock_;
  bool running_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace ergotic::station
