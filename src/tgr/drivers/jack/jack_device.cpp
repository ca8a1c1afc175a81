// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/jack/jack_device.hpp"

#include <algorithm>
#include <cmath>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

const JackDeviceConfig& checked(const JackDeviceConfig& config) {
  const VirtualDriverConfig& bank = config.bank;
  if (!bank.shared_memory.empty() || bank.extra_delay_ticks != 0 || bank.slice.volts) {
    throw Exception(
        "shared_memory, extra_delay_ticks and volts are settings of a driver, not of a device "
        "behind a sound card");
  }
  if (!bank.gesture_file.empty() && bank.gesture_rate == 0.0 &&
      gestureKindOf(bank.gesture_file) == GestureKind::kPositions) {
    throw Exception(bank.gesture_file +
                    ": positions per tick need a gesture rate: a device knows no ticks");
  }
  requireWithin("metres per unit", config.metres_per_unit, 1e-4, 1.0, "m");
  requireWithin("newtons per unit", config.newtons_per_unit, 0.1, 1000.0, "N");
  requireWithin("latency", config.latency_frames, 0, 1 << 16, "frames");
  requireWithin("watchdog", config.watchdog_s, 0.0, 10.0, "s");
  return config;
}

}  // namespace

JackDevice::JackDevice(const JackDeviceConfig& config)
    : config_(checked(config)),
      bank_(config.bank),
      forces_(static_cast<std::size_t>(bank_.slices())),
      positions_(forces_.size()),
      delayed_(forces_.size() * static_cast<std::size_t>(config.latency_frames)) {}

audio::JackConfig JackDevice::jackConfig(const std::string& client,
                                         const std::string& server) const {
  audio::JackConfig jack;
  jack.name = client;
  jack.server = server;
  jack.inputs = bank_.slices() + 1;
  jack.outputs = bank_.slices();
  for (int i = 1; i <= bank_.slices(); ++i) {
    jack.input_names.push_back("force_" + std::to_string(i));
    jack.output_names.push_back("position_" + std::to_string(i));
  }
  jack.input_names.emplace_back("heartbeat");
  audio::JackTerminal end;
  end.input_latency_periods = 1;
  end.output_latency_frames =
      config_.declares_latency ? static_cast<std::uint32_t>(config_.latency_frames) : 0U;
  jack.terminal = end;
  return jack;
}

int JackDevice::declaredFrames(std::uint32_t period) const noexcept {
  return static_cast<int>(period) + (config_.declares_latency ? config_.latency_frames : 0);
}

void JackDevice::audioStarted(double sample_rate_hz, std::uint32_t /*period_frames*/) {
  bank_.start(1.0 / sample_rate_hz, sample_rate_hz);
  std::fill(delayed_.begin(), delayed_.end(), 0.0F);
  oldest_ = 0;
  frame_ns_ = kNsPerS / sample_rate_hz;
  watchdog_frames_ = std::llround(config_.watchdog_s * sample_rate_hz);
  since_beat_ = watchdog_frames_;
}

void JackDevice::audioStopped() noexcept {
  const std::int64_t now_ns = std::max(rt::monotonicNs(), end_ns_);
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    feel(i, 0.0, now_ns);
  }
}

void JackDevice::process(const rt::Period& period) noexcept {
  const auto slices = forces_.size();
  end_ns_ = period.start.time_ns + std::llround(period.nframes * frame_ns_);
  for (std::uint32_t frame = 0; frame < period.nframes; ++frame) {
    bank_.read(positions_.data());
    for (std::size_t i = 0; i < slices; ++i) {
      const auto units = static_cast<float>(positions_[i] / config_.metres_per_unit);
      float& out = period.outputs[i][frame];
      out = delayed_.empty() ? units : std::exchange(delayed_[oldest_ + i], units);
    }
    oldest_ = oldest_ + slices < delayed_.size() ? oldest_ + slices : 0;
    takeForces(period, frame);
    bank_.step(forces_.data());
  }
}

void JackDevice::takeForces(const rt::Period& period, std::uint32_t frame) noexcept {
  const bool may_push = mayPush(period, frame);
  const std::int64_t now_ns = period.start.time_ns + std::llround(frame * frame_ns_);
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    const double asked = may_push ? static_cast<double>(period.inputs[i][frame]) : 0.0;
    feel(i, bank_.newtons(static_cast<int>(i), asked * config_.newtons_per_unit), now_ns);
  }
}

bool JackDevice::mayPush(const rt::Period& period, std::uint32_t frame) noexcept {
  if (watchdog_frames_ == 0) {
    return true;
  }
  const float heartbeat = period.inputs[forces_.size()][frame];
  const bool beats = heartbeat != 0.0F && (heartbeat > 0.0F) != beat_;
  since_beat_ = beats ? 0 : std::min(since_beat_ + 1, watchdog_frames_);
  beat_ = beats ? heartbeat > 0.0F : beat_;
  return since_beat_ < watchdog_frames_;
}

void JackDevice::feel(std::size_t slice, double force, std::int64_t time_ns) noexcept {
  if (force == forces_[slice]) {
    return;
  }
  forces_[slice] = force;
  if (!records_.push({time_ns, static_cast<std::int32_t>(slice), force})) {
    dropped_records_.fetch_add(1, std::memory_order_relaxed);
  }
}

}  // namespace ergotic::tgr
