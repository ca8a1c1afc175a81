// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ergotic/audio/jack_client.hpp"
#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/station/station.hpp"
#include "ergotic/station/timer_source.hpp"
#include "ergotic/tgr/safety/guardian.hpp"
#include "ergotic/tgr/safety/watchdog.hpp"
#include "ros/device/hands.hpp"
#include "ros/device/parameters.hpp"
#include "ros/interface/master_watch.hpp"

namespace ergotic::node {

/// A running station with its device, its real-time thread and its audio host.
class Engine {
 public:
  /// Opens the devices, starts to tick, looks for a JACK server. Forces stay at zero.
  /// \param hands  probed at the performer's rate
  /// \throws DeviceError or Exception saying what is missing
  Engine(const Parameters& parameters,
         std::unique_ptr<Hands> hands,
         std::unique_ptr<station::Performer> performer,
         std::shared_ptr<station::Interlock> interlock);
  /// Forces to zero, threads ended, device closed.
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  station::Station& station() { return *station_; }
  const Parameters& parameters() const { return parameters_; }
  Hands& hands() { return *hands_; }

  /// Forces to zero as soon as the ROS master does not lead to these services and topics of this
  /// process any more, and as long. Thread: setup
  void watchMaster(const std::vector<std::string>& services,
                   const std::vector<std::string>& topics);

  /// Gets lost devices back and watches the ticks again. Thread: command thread
  /// \throws DeviceError if a device is still lost, Exception if the ROS master is
  void recover();

  /// The watchdog acted and no tick came since: the station cannot say so itself. Thread: any
  bool standsStill() const { return silent_at_ == station_->heartbeat(); }

  /// \return false if no MIDI message waits, or it plays without JACK. Thread: one, any
  bool popMidi(station::MidiArrival& arrival) { return bridge_ && bridge_->popMidi(arrival); }

  /// \return null if it plays without JACK
  station::AudioBridge* bridge() { return bridge_.get(); }

  /// Thread: any
  station::Loudness loudness() const { return bridge_ ? bridge_->loudness() : station::Loudness(); }
  tgr::WatchdogReading watchdogReading() const { return watchdog_->reading(); }  ///< Thread: any
  /// \return nothing if it plays without JACK. Thread: any
  std::optional<audio::JackStatus> jackStatus() const;
  /// \throws Exception if it plays without JACK
  void requireJack() const;
  /// Ends the client that makes the sound, which then begins anew: a fault on purpose.
  /// \pre requireJack()
  void dropJack() { jack_->drop(); }
  /// Warnings since the last call, of the real-time thread and of the audio host.
  std::vector<std::string> takeWarnings();

 private:
  void startWatchdog();
  std::string startGuardian();
  void keepGuardian();
  void watchGuardian();

  Parameters parameters_;
  std::unique_ptr<Hands> hands_;  // outlives the station, which has its drivers
  std::unique_ptr<station::Station> station_;
  std::unique_ptr<station::AudioBridge> bridge_;
  std::unique_ptr<station::TickSource> source_;
  std::unique_ptr<audio::JackHost> jack_;
  std::mutex
      guardian_mutex_;  // of the next two, between the command thread and the watchdog's beats
  std::vector<tgr::Guard> guards_;  // what the guardian holds; none: the device needs no guardian
  std::unique_ptr<tgr::Guardian> guardian_;
  std::atomic<bool> guardian_lost_{false};  // there should be one that looks
  std::int64_t guardian_retry_ns_ = 0;      // where there is none
  std::unique_ptr<tgr::Watchdog> watchdog_;
  std::unique_ptr<MasterWatch> master_watch_;
  double watchdog_s_ = 0.0;
  std::atomic<std::int64_t> silent_at_{-1};  // tick after which the watchdog acted last
  std::vector<std::string> warnings_;
};

/// The sample rate of the JACK server, which a whole run keeps.
/// \param name  of the station's client; the one that asks is another
/// \return nothing if no server appears within `wait_s`. Blocks as long
std::optional<double> findJackRate(const std::string& name, double wait_s);

}  // namespace ergotic::node
