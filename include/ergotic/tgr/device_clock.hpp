// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::tgr {

/// What wants to be called once per tick.
class TickTarget {
 public:
  virtual ~TickTarget() = default;
  /// One tick is due, in the device's real-time thread. Realtime: yes
  /// \param late_ns  after its due time, CLOCK_MONOTONIC
  virtual void tick(std::int64_t late_ns) noexcept = 0;
  /// The device skipped this many ticks; exchange serves the newest sample. Realtime: yes
  virtual void missed(std::int64_t ticks, std::int64_t stall_ns) noexcept = 0;
};

/// A device with a clock of its own (a sound card): it asks for ticks, at the rate told to
/// `Driver::open`, from its own real-time thread, in which `exchange` then comes.
class DeviceClock {
 public:
  virtual ~DeviceClock() = default;
  /// Ticks come from here on. \pre the driver is open. Realtime: no. Thread: setup
  virtual void start(TickTarget& target) = 0;
  /// No tick runs after the return. Idempotent. Realtime: no. Thread: setup
  virtual void stop() noexcept = 0;
  /// Time between its bursts of ticks, s: without harm no tick may come for so long. \pre the
  /// driver is open. Realtime: no. Thread: any
  virtual double periodS() const noexcept = 0;
};

}  // namespace ergotic::tgr
