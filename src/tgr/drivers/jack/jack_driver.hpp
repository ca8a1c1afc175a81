// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ergotic/audio/jack_client.hpp"
#include "ergotic/tgr/driver.hpp"
#include "tgr/drivers/jack/jack_settings.hpp"
#include "tgr/drivers/jack/jack_ticks.hpp"

namespace ergotic::tgr {

/// A TGR wired to a DC-coupled sound card: capture ports are positions, playback ports forces, in
/// volts. Its ticks come from JACK's real-time thread.
///
/// Each position has its port alone, each force too: another connection to one of them, or one that
/// is missing, counts as a lost device, and the force is zero until the wire is as it was.
class JackDriver final : public Driver {
 public:
  /// \throws Exception if a setting is outside its range
  explicit JackDriver(const JackDriverConfig& config);
  ~JackDriver() override { close(); }
  JackDriver(const JackDriver&) = delete;
  JackDriver& operator=(const JackDriver&) = delete;

  /// Waits up to `wait_s` for server and ports, and as long for JACK to know the round trip.
  /// \throws DeviceError if they are not there, or rate, period or round trip do not fit
  void open(double tick_rate_hz) override;
  void close() noexcept override;
  /// Waits as `open` does; JACK itself is looked for all the time.
  void reconnect() override;
  int slices() const noexcept override { return slices_; }
  ERGOTIC_REALTIME std::uint32_t exchange(const double* forces,
                                          double* positions) noexcept override {
    return ticks_.exchange(forces, positions);
  }
  /// The block that comes next is zero; it stays so without any tick.
  void makeSafe() noexcept override { ticks_.makeSafe(); }
  void rearm() noexcept override { ticks_.rearm(); }
  int extraDelayTicks() const noexcept override { return extra_delay_ticks_; }
  bool isRaw() const noexcept override { return true; }
  double damping() const noexcept override { return config_.damping.value_or(kSupposedDamping); }
  double declaredDamping() const noexcept override { return config_.damping.value_or(0.0); }
  std::vector<Guard> guards() const override;
  DeviceClock* clock() noexcept override { return &ticks_; }

  /// Frames from a position at the plug to the force of the same tick at the plug. \pre open
  int roundTripFrames() const noexcept { return round_trip_frames_; }
  /// Thread: any \pre open
  audio::JackStatus status() const { return host_->status(); }

 private:
  void waitForDevice() const;
  int waitForRoundTrip() const;
  std::optional<audio::JackStatus> lookUntil(
      const std::function<bool(const audio::JackStatus&)>& suits) const;
  std::uint32_t roundTrip(const audio::JackStatus& status) const noexcept;  ///< frames

  JackDriverConfig config_;
  int slices_;
  JackTicks ticks_;
  std::unique_ptr<audio::JackHost> host_;
  int round_trip_frames_ = 0;
  int extra_delay_ticks_ = 0;
};

class JackFactory final : public DriverFactory {
 public:
  std::unique_ptr<Driver> make(const YAML::Node& settings, const std::string& place) const override;
};

}  // namespace ergotic::tgr
