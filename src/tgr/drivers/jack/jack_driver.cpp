// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/jack/jack_driver.hpp"

#include <cmath>
#include <sstream>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

std::vector<std::string> numbered(const std::string& prefix, int count) {
  std::vector<std::string> names;
  for (int i = 1; i <= count; ++i) {
    names.push_back(prefix + std::to_string(i));
  }
  return names;
}

audio::JackConfig jackConfig(const JackDriverConfig& driver) {
  audio::JackConfig config;
  config.name = driver.client;
  config.server = driver.server;
  config.inputs = static_cast<int>(driver.position_ports.size());
  config.outputs = static_cast<int>(driver.force_ports.size());
  config.input_names = numbered("position_", config.inputs);
  config.output_names = numbered("force_", config.outputs);
  config.input_peers = driver.position_ports;
  config.output_peers = driver.force_ports;
  if (!driver.heartbeat_port.empty()) {
    ++config.outputs;
    config.output_names.emplace_back("heartbeat");
    config.output_peers.push_back(driver.heartbeat_port);
  }
  return config;
}

}  // namespace

JackDriver::JackDriver(const JackDriverConfig& config)
    : config_(config),
      slices_(static_cast<int>(config.position_ports.size())),
      ticks_(slices_, config.volts_per_unit) {
  requireWithin("slices", slices_, 1, kMaxSlices, "");
  requireWithin("force ports", static_cast<double>(config.force_ports.size()), slices_, slices_,
                "");
}

void JackDriver::open(double tick_rate_hz) {
  close();
  ticks_.open(tick_rate_hz);
  try {
    host_ = std::make_unique<audio::JackHost>(jackConfig(config_), ticks_);
    waitForDevice();
    round_trip_frames_ = waitForRoundTrip();
  } catch (const Exception&) {
    close();
    throw;
  }
  ticks_.pin();
  const int ratio = ticks_.ratio();
  extra_delay_ticks_ = (round_trip_frames_ + ratio - 1) / ratio;
}

void JackDriver::close() noexcept {
  ticks_.close();
  host_.reset();
}

void JackDriver::reconnect() {
  if (!host_) {
    throw DeviceError("jack device " + config_.client + " is not open");
  }
  waitForDevice();
}

std::vector<Guard> JackDriver::guards() const {
  const audio::JackStatus status = host_->status();
  Guard guard{{"jack", config_.server}, -1, status.starts};
  for (const std::string& port : jackConfig(config_).output_names) {
    guard.words.push_back(status.client + ":" + port);
  }
  return {guard};
}

void JackDriver::waitForDevice() const {
  // What was seen before is no proof, nor is the look that may be under way.
  const std::int64_t fresh = host_->status().looks + 2;
  const auto there = lookUntil([fresh](const audio::JackStatus& status) {
    return status.looks >= fresh && status.running && status.wired;
  });
  if (!there) {
    const std::string message = host_->status().message;
    std::ostringstream error;
    error << "jack device " << config_.client << ": waited " << config_.wait_s
          << " s: " << (message.empty() ? "JACK does not answer" : message);
    throw DeviceError(error.str());
  }
}

/// Waits until the round trip is known. A measured value takes precedence over the one that JACK
/// declares; no round trip is shorter than a period. JACK reports latencies some time after the
/// ports are connected.
int JackDriver::waitForRoundTrip() const {
  const bool is_measured = config_.round_trip_frames > 0;
  const auto known = lookUntil([&](const audio::JackStatus& status) {
    return is_measured || (status.wired && roundTrip(status) >= status.period_frames);
  });
  const audio::JackStatus status = known.value_or(host_->status());
  if (roundTrip(status) < status.period_frames) {
    throw DeviceError("jack device " + config_.client + ": the round trip is " +
                      std::to_string(roundTrip(status)) + " frames " +
                      (is_measured ? "by round_trip_frames" : "by JACK") +
                      ", allowed: at least the period, " + std::to_string(status.period_frames));
  }
  return static_cast<int>(roundTrip(status));
}

/// \return nothing if no status that suits is seen within `wait_s`. \throws DeviceError if rate or
/// period do not fit
std::optional<audio::JackStatus> JackDriver::lookUntil(
    const std::function<bool(const audio::JackStatus&)>& suits) const {
  constexpr std::int64_t kPauseNs = 20'000'000;
  const std::int64_t end_ns = rt::monotonicNs() + std::llround(config_.wait_s * 1e9);
  while (true) {
    host_->look();
    const audio::JackStatus status = host_->status();
    if (suits(status)) {
      return status;
    }
    const std::string refusal = ticks_.refusal();
    if (!refusal.empty()) {
      throw DeviceError("jack device " + config_.client + ": " + refusal);
    }
    const std::int64_t now_ns = rt::monotonicNs();
    if (now_ns >= end_ns) {
      return std::nullopt;
    }
    rt::sleepUntilNs(now_ns + kPauseNs);
  }
}

std::uint32_t JackDriver::roundTrip(const audio::JackStatus& status) const noexcept {
  return config_.round_trip_frames > 0 ? static_cast<std::uint32_t>(config_.round_trip_frames)
                                       : status.input_latency_frames + status.output_latency_frames;
}

std::unique_ptr<Driver> JackFactory::make(const YAML::Node& settings,
                                          const std::string& place) const {
  return std::make_unique<JackDriver>(readJackSettings(settings, place));
}

}  // namespace ergotic::tgr
