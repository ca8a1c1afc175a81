// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "audio/gate.hpp"
#include "ergotic/rt/audio_processor.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/tgr/device_clock.hpp"
#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// Cuts the periods of a sound card into ticks: inputs are positions, outputs forces.
///
/// A period of P frames is P/R ticks, run one after the other as soon as the period is there. Tick
/// k reads the mean of the input frames k R ... k R + R - 1: all of them are there already, so this
/// is no later than the first of them alone, it has less noise by sqrt(R), and what vibrates faster
/// than half the tick rate does not fold back unattenuated. Its force stands in the output frames
/// of the same numbers. Frames that no tick writes are zero.
///
/// Frames that the host left out become ticks that were missed, after a restart those of the time
/// that has passed.
class JackTicks final : public rt::AudioProcessor, public DeviceClock {
 public:
  /// Output `slices`, if the host has so many, is the heartbeat: +-kHeartbeat, another sign each
  /// period, zero when there is no tick or no force is allowed.
  static constexpr float kHeartbeat = 0.5F;

  JackTicks(int slices, double volts_per_unit) noexcept
      : slices_(slices), volts_per_unit_(volts_per_unit) {}

  // The driver. Thread: setup
  /// Prepares for ticks, before the host lives. \param hz  rate of the ticks
  void open(double tick_rate_hz);
  /// Blocks of another period are refused from here on: delay limits rest on it.
  void pin() noexcept { pinned_ = period_.load(); }
  /// Ends the ticks, after the host has gone.
  void close() noexcept { open_ = false; }
  /// Reason why the host was refused last, empty: it was not. Thread: any
  std::string refusal() const;
  /// Frames of a tick, of a period. \pre the host has started
  int ratio() const noexcept { return ratio_; }
  std::uint32_t period() const noexcept { return period_; }

  // Thread: any
  void makeSafe() noexcept { safe_ = true; }
  void rearm() noexcept { safe_ = false; }
  std::int64_t xruns() const noexcept { return xruns_; }

  /// Exchanges as Driver::exchange, in volts. Within a tick only forces are taken. Realtime: yes.
  /// Thread: tick
  ERGOTIC_REALTIME std::uint32_t exchange(const double* forces, double* positions) noexcept;

  // DeviceClock
  void start(TickTarget& target) override;
  void stop() noexcept override { gate_.close(); }
  /// Duration of a period of the host, s.
  double periodS() const noexcept override { return period_ / (ratio_ * tick_rate_hz_); }

  // The host
  /// \throws Exception if rate or period do not fit the ticks
  void audioStarted(double sample_rate_hz, std::uint32_t period_frames) override;
  void audioStopped() noexcept override { running_ = false; }
  ERGOTIC_REALTIME void process(const rt::Period& period) noexcept override;
  void xrun() noexcept override { xruns_.fetch_add(1, std::memory_order_relaxed); }

 private:
  void checkRates(double sample_rate_hz, std::uint32_t period_frames) const;
  std::int64_t framesLeftOut(const rt::Period& period) noexcept;
  void catchUp() noexcept;
  void runTicks(const rt::Period& period) noexcept;
  void beat(const rt::Period& period) noexcept;
  void readPositions() noexcept;
  void writeForces(const double* forces) noexcept;

  int slices_;
  double volts_per_unit_;

  // Set while no period is processed.
  double tick_rate_hz_ = 0.0;
  std::atomic<int> ratio_{1};
  std::atomic<std::uint32_t> period_{0};
  double frame_ns_ = 0.0;
  bool restarted_ = true;
  TickTarget* target_ = nullptr;

  // Shared.
  std::atomic<std::uint32_t> pinned_{0};  // 0: any period will do
  std::atomic<bool> open_{false};
  std::atomic<bool> running_{false};
  std::atomic<bool> safe_{false};
  std::atomic<std::int64_t> xruns_{0};
  audio::Gate gate_;               // open from start to stop
  std::atomic<bool> fresh_{true};  // the clock was just started: nothing was missed before
  mutable std::mutex refusal_mutex_;
  std::string refusal_;

  // The host's real-time thread.
  std::int64_t next_frame_ = 0;  // after the last period
  std::int64_t next_ns_ = 0;     // when it begins
  std::int64_t owed_ = 0;        // frames left out that were not yet missed ticks
  float beat_ = kHeartbeat;
  const rt::Period* now_ = nullptr;                  // while ticks run
  std::uint32_t first_ = 0;                          // frame of the tick
  bool may_push_ = false;                            // the tick has output frames
  std::array<double, kMaxSlices> last_positions_{};  // V
};

}  // namespace ergotic::tgr
