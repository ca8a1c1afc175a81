// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::tgr {

/// Receiver of the ticks of a device clock, called once per tick.
class TickTarget {
 public:
  virtual ~TickTarget() = default;
  /// Runs the tick that is due, in the device's real-time thread. Realtime: yes
  /// \param late_ns  delay after its due time, CLOCK_MONOTONIC
  virtual void tick(std::int64_t late_ns) noexcept = 0;
  /// The device skipped this many ticks; exchange serves the newest sample. Realtime: yes
  virtual void missed(std::int64_t ticks, std::int64_t stall_ns) noexcept = 0;
};

/// A device with a clock of its own (a sound card): it requests ticks, at the rate given to
/// `Driver::open`, from its own real-time thread, which then calls `exchange`.
class DeviceClock {
 public:
  virtual ~DeviceClock() = default;
  /// Ticks come from here on. \pre the driver is open. Realtime: no. Thread: setup
  virtual void start(TickTarget& target) = 0;
  /// Stops the ticks: none runs after the return. Idempotent. Realtime: no. Thread: setup
  virtual void stop() noexcept = 0;
  /// Longest time between bursts of ticks, s; so long a pause of ticks is normal. \pre the driver
  /// is open. Realtime: no. Thread: any
  virtual double periodS() const noexcept = 0;
};

}  // namespace ergotic::tgr
