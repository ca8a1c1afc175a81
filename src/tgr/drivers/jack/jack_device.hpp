// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "ergotic/audio/jack_client.hpp"
#include "ergotic/rt/audio_processor.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/rt/ring.hpp"
#include "tgr/drivers/virtual/force_record.hpp"
#include "tgr/drivers/virtual/slice_bank.hpp"

namespace ergotic::tgr {

struct JackDeviceConfig {
  VirtualDriverConfig bank;       ///< its slices, in metres and newtons; nothing of a driver
  double metres_per_unit = 0.05;  ///< position at full scale, 1e-4...1
  double newtons_per_unit = 200;  ///< force at full scale, 0.1...1000
  int latency_frames = 0;  ///< latency of its converters, in the path of the positions, 0...65536
  bool declares_latency = true;  ///< to JACK; real converters often do not
  double watchdog_s = 0.0;       ///< longest time between heartbeats, 0...10; 0: no watchdog
};

/// A virtual TGR behind a sound card of its own: a JACK client that takes forces (and a heartbeat)
/// and gives positions, sample by sample.
///
/// Frame n of the positions is sampled before the force of frame n acts. JACK closes the loop
/// through a driver with one period of delay; the rest of the round trip is `latency_frames`.
///
/// With a watchdog there is force only while the heartbeat changes its sign; an amplifier behind a
/// plain sound card has no such watchdog. Without blocks there is no force either.
class JackDevice final : public rt::AudioProcessor {
 public:
  /// \throws TextError and Exception as SliceBank, Exception if a number is out of range
  explicit JackDevice(const JackDeviceConfig& config);

  /// Configuration of the client that plays it: ports `force_1`..., `heartbeat`, and
  /// `position_1`... .
  audio::JackConfig jackConfig(const std::string& client, const std::string& server) const;
  /// Round trip that is declared to JACK, at this period.
  int declaredFrames(std::uint32_t period) const noexcept;

  void audioStarted(double sample_rate_hz, std::uint32_t period_frames) override;
  void audioStopped() noexcept override;
  ERGOTIC_REALTIME void process(const rt::Period& period) noexcept override;
  void xrun() noexcept override { xruns_.fetch_add(1, std::memory_order_relaxed); }

  /// \return false if there is no record. Thread: one, any
  bool pollForce(ForceRecord& record) noexcept { return records_.pop(record); }
  std::int64_t droppedRecords() const noexcept { return dropped_records_; }
  std::int64_t xruns() const noexcept { return xruns_; }

 private:
  ERGOTIC_REALTIME void takeForces(const rt::Period& period, std::uint32_t frame) noexcept;
  ERGOTIC_REALTIME bool mayPush(const rt::Period& period, std::uint32_t frame) noexcept;
  void feel(std::size_t slice, double force, std::int64_t time_ns) noexcept;

  JackDeviceConfig config_;
  SliceBank bank_;
  std::vector<double> forces_;     // N, as felt
  std::vector<double> positions_;  // m, now
  std::vector<float> delayed_;     // [latency][slices] units under way
  std::size_t oldest_ = 0;
  double frame_ns_ = 0.0;
  std::int64_t end_ns_ = 0;  // of the last block, in which forces are felt ahead of time
  std::int64_t watchdog_frames_ = 0;
  std::int64_t since_beat_ = 0;  // frames
  bool beat_ = false;            // its last sign
  rt::Ring<ForceRecord> records_{1U << 18U};
  std::atomic<std::int64_t> dropped_records_{0};
  std::atomic<std::int64_t> xruns_{0};
};

}  // namespace ergotic::tgr
