// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "ergotic/station/audio_bridge.hpp"
#include "ergotic/station/station.hpp"
#include "ergotic/station/tick_schedule.hpp"
#include "ergotic/station/tick_source.hpp"

namespace ergotic::station {

struct TimerOptions {
  int priority = 75;        ///< SCHED_FIFO, 1...99; 0: an ordinary thread
  bool lock_memory = true;  ///< lock the memory of the whole process
  int cpu = -1;             ///< CPU that the thread runs on, -1: any
};

/// Ticks a station in a real-time thread of its own, at absolute times of CLOCK_MONOTONIC: those of
/// the audio host's frame clock while there is one, evenly spaced ones otherwise.
///
/// All functions: Realtime: no. Thread: setup
class TimerSource final : public TickSource {
 public:
  /// \param bridge  may be null: no audio host, ever. Both must outlive the source.
  TimerSource(Station& station, AudioBridge* bridge) noexcept
      : station_(station), bridge_(bridge) {}
  ~TimerSource() override { stop(); }
  TimerSource(const TimerSource&) = delete;
  TimerSource& operator=(const TimerSource&) = delete;

  /// Returns when the thread is set up and about to tick. What the system refuses (priority,
  /// memory, cpu) becomes a warning; the ticks run all the same. \pre not running \throws Exception
  /// if an option is outside its range
  void start(const TimerOptions& options);

  void stop() noexcept override;
  bool isRunning() const noexcept override { return thread_.joinable(); }
  const std::vector<std::string>& warnings() const noexcept override { return warnings_; }

 private:
  void setUpThread(const TimerOptions& options);
  void run() noexcept;
  void follow(TickSchedule& schedule) noexcept;

  Station& station_;
  AudioBridge* bridge_;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  std::vector<std::string> warnings_;
};

}  // namespace ergotic::station
