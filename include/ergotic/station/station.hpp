// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ergotic/rt/mailbox.hpp"
#include "ergotic/rt/ring.hpp"
#include "ergotic/station/messages.hpp"
#include "ergotic/station/performer.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/safety_chain.hpp"

namespace ergotic::station {

struct StationConfig {
  physics::Rates rates;
  int output_channels = 24;  ///< audio channels out; a model's higher channels are dropped
  int input_channels = 12;
  tgr::SafetyConfig safety;
  double max_stall_s = 0.05;               ///< longer ones are a Fault
  double display_hz = 60.0;                ///< how often snapshots and motion are published
  std::size_t record_ring = 1U << 15U;     ///< gesture ticks
  std::size_t event_ring = 1U << 12U;      ///< events
  std::size_t command_ring = 1U << 8U;     ///< commands
  std::size_t keyframe_bytes = 1U << 24U;  ///< largest state that a keyframe can hold
};

/// Where the audio of a tick goes and comes from. Realtime: yes. Thread: tick
class FramePort {
 public:
  virtual ~FramePort() = default;
  /// \param frames  [nframes][output channels of the station], station frame `first` onwards
  virtual void push(std::int64_t first, const float* frames, int nframes) noexcept = 0;
  /// Fills [nframes][input channels of the station]; silence where there is none.
  /// \return false if all of it is silence
  virtual bool pull(std::int64_t first, float* frames, int nframes) noexcept = 0;
};

/// State of an instrument at the start of a recording.
struct Keyframe {
  std::int64_t tick = 0;  ///< the first tick to be run from this state
  std::vector<std::uint8_t> state;
  std::vector<double> parameters;
};

/// The room around the instrument. One thread, the tick's, calls `cycle` and `catchUp`; one other
/// thread, the operator's, calls everything below "operator".
///
/// Tick n: driver.exchange(F[n-1]) -> x[n]; validate; commands; instrument.tick(x[n]) -> F[n], R
/// frames; safety chain; records. F[n] goes out with the exchange that reads x[n+1].
class Station {
 public:
  /// Opens the driver. Realtime: no.
  /// \throws DeviceError from the driver, Exception if the performer's rates are not the config's
  Station(const StationConfig& config,
          std::unique_ptr<tgr::Driver> driver,
          std::unique_ptr<Performer> performer);
  ~Station();  ///< forces to zero, driver closed
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  /// Where audio goes; null: nowhere. \pre no tick is running
  void setFramePort(FramePort* port) noexcept { frame_port_ = port; }

  /// How late a tick began and what it was waiting for, told by the tick source.
  struct Timing {
    std::int64_t late_ns = 0;  ///< after its due time
  };
  /// One tick. Realtime: yes. Thread: tick
  void cycle(const Timing& timing) noexcept;

  /// `ticks` ticks at once after a stall: positions interpolated to the new sample, force muted,
  /// then ramped in again. Beyond max_stall: Fault. Realtime: yes. Thread: tick
  void catchUp(int ticks, std::int64_t stall_ns) noexcept;

  /// Compute time of a tick is measured against this. \pre no tick is running
  const StationConfig& config() const noexcept { return config_; }

  // Any thread:
  /// Forces to zero at once, latched (Fault kMadeSafe): for signals and watchdogs.
  void makeSafe() noexcept;

  // Operator:
  /// \return false if the ring is full (nothing is taken)
  bool submit(const Command& command) noexcept { return commands_.push(command); }
  bool poll(Event& event) noexcept { return events_.pop(event); }
  std::size_t pollGestures(GestureTick* to, std::size_t count) noexcept {
    return gestures_.pop(to, count);
  }
  /// Newest snapshot, if there is one not yet seen.
  const Snapshot* snapshot() noexcept {
    return snapshots_.refresh() ? &snapshots_.latest() : nullptr;
  }
  /// Valid from an Event::kKeyframe to the next Command::kKeyframe.
  const Keyframe& keyframe() const noexcept { return keyframe_; }
  tgr::Driver& driver() noexcept { return *driver_; }
};

}  // namespace ergotic::station
