// SPDX-License-Identifier: BSD-3-Clause
// What a tick tells: records, snapshots, lateness, events.
#include <algorithm>

#include "ergotic/station/station.hpp"

namespace ergotic::station {

void Station::record(const Slices& positions, std::uint32_t flags) noexcept {
  GestureTick gesture;
  gesture.tick = tick_;
  gesture.flags = flags;
  gesture.slices = static_cast<std::uint32_t>(slices_);
  for (std::size_t s = 0; s < gesture.slices; ++s) {
    gesture.position[s] = positions[s];
    gesture.force[s] = static_cast<float>(force_[s]);
  }
  gesture.ports = static_cast<std::uint32_t>(performer_->positions.size());
  std::copy(performer_->positions.begin(), performer_->positions.end(), gesture.port.begin());
  if (!gestures_.push(gesture)) {
    ++counters_.dropped_records;
  }
}

void Station::publish() noexcept {
  Snapshot& s = snapshots_.draft();
  const AudioStatus audio = frame_port_ != nullptr ? frame_port_->status() : AudioStatus{};
  s.tick = tick_;
  s.stall_s = stall_s_;
  s.stalls_borne = stalls_borne_;
  const Interlock::Reading force = interlock_->read();
  s.state = force.state;
  s.fault = force.reason;
  s.audio_running = audio.running;
  s.clock_locked = audio.clock_locked;
  s.counters = counters_;
  s.counters.underruns = audio.underruns;
  s.counters.underrun_frames = audio.underrun_frames;
  s.counters.xruns = audio.xruns;
  s.counters.dropped_records += audio.dropped_records;
  for (int slice = 0; slice < slices_; ++slice) {
    const tgr::SliceReading reading = chain_.reading(slice);
    s.counters.port_energy_min_j = std::min(s.counters.port_energy_min_j, reading.least_energy_j);
    s.counters.clamped_ticks += reading.clamped_ticks;
    s.counters.muted_ticks += reading.muted_ticks;
    s.counters.peak_raw_force_n = std::max(s.counters.peak_raw_force_n, reading.peak_raw_force_n);
  }
  s.slice_position = position_;
  s.slice_velocity = velocity_;
  s.slice_force = force_;
  s.slices = slices_;
  snapshots_.publish();
  if (!blown_up_) {
    performer_->publishMotion(tick_);
  }
}

void Station::relayAudioEvents() noexcept {
  constexpr int kAudioEventsPerTick = 4;
  Event audio;
  for (int i = 0; i < kAudioEventsPerTick && frame_port_ != nullptr; ++i) {
    if (!frame_port_->popEvent(audio)) {
      return;
    }
    tell(audio);
  }
}

void Station::classify(const Timing& timing,
                       std::int64_t exchange_ns,
                       std::int64_t compute_ns) noexcept {
  const double load = static_cast<double>(compute_ns) / tick_ns_;
  counters_.load_mean += (load - counters_.load_mean) * 1e-9 * tick_ns_;  // over about a second
  counters_.load_peak = std::max(counters_.load_peak, load);
  if (timing.freewheel) {
    return;
  }
  counters_.late_worst_s =
      std::max(counters_.late_worst_s, 1e-9 * static_cast<double>(timing.late_ns));
  if (meter_ != nullptr) {
    meter_->add(timing.late_ns, exchange_ns, compute_ns);
  }
  late(LateCause::kWakeUp, counters_.late_wake_up, timing.late_ns);
  late(LateCause::kDevice, counters_.late_device, exchange_ns);
  late(LateCause::kCompute, counters_.late_compute, compute_ns);
}

void Station::late(LateCause cause, std::int64_t& counter, std::int64_t ns) noexcept {
  if (static_cast<double>(ns) <= tick_ns_) {
    return;
  }
  ++counter;
  Event told = event(Event::Type::kLateTick);
  told.tick = tick_ - 1;  // the one that just ran
  told.index = static_cast<std::int64_t>(cause);
  told.value = 1e-9 * static_cast<double>(ns);
  tell(told);
}

Event Station::event(Event::Type type) const noexcept {
  Event told;
  told.type = type;
  told.tick = tick_;
  told.frame = tick_ * config_.rates.ratio;
  return told;
}

/// Sends an event that may be lost, and counts losses; reserves room for events that may not be
/// lost.
void Station::tell(const Event& event) noexcept {
  if (events_.writable() <= config_.command_ring || !events_.push(event)) {
    ++counters_.dropped_records;
  }
}

/// Sends an event with an object. It never fails: `submit` admits only as many owning commands as
/// `tell` leaves places for.
void Station::handBack(const Event& event) noexcept {
  events_.push(event);
}

}  // namespace ergotic::station
