// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace ergotic::tgr {

struct WatchdogOptions {
  double period_s = 0.02;  ///< silence before it acts, 0.004...1
  /// SCHED_FIFO, 1...99, above the tick's: a tick that never ends must not keep it from the
  /// processor. 0: an ordinary thread.
  int priority = 80;
  std::function<void()> beat = [] {};  ///< called with each look, in its thread
};

/// Readings of a watchdog since it was made, for diagnostics.
struct WatchdogReading {
  std::int64_t bites = 0;           ///< number of times it acted
  std::int64_t silence_ns = 0;      ///< time since the last tick, when it last acted
  std::int64_t machine_stalls = 0;  ///< stalls of the machine or the process, longer than a period
  std::int64_t longest_stall_ns = 0;  ///< longest of these stalls
};

/// Makes a device safe when ticks stop coming: a thread outside the real-time one that looks at a
/// counter of ticks four times in a period.
///
/// It acts once, between 1 and 1.25 periods after the last tick, and then rests until it is armed
/// again. It ignores a stall of the whole machine, see TickWatch: the tick source detects that one
/// itself, and during it only the device's own watchdog can act.
class Watchdog {
 public:
  /// Action when ticks have stopped. Thread: the watchdog's
  /// \param silence_ns  since the last tick
  using Bite = std::function<void(std::int64_t silence_ns)>;

  /// \param ticks  grows with every tick; outlives the watchdog
  Watchdog(const std::atomic<std::int64_t>& ticks, Bite bite);
  ~Watchdog() { stop(); }
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Disarmed at first. Realtime: no. Thread: setup. \pre not running
  /// \throws Exception if an option is outside its range
  void start(const WatchdogOptions& options);
  /// Idempotent; takes at most a quarter of a period. Realtime: no. Thread: setup
  void stop() noexcept;
  bool isRunning() const noexcept { return thread_.joinable(); }
  /// Warning: what the system refused to `start`, and what to do about it; empty: none. Thread:
  /// setup
  const std::string& warning() const noexcept { return warning_; }

  /// Watches from the next tick on. Realtime: yes. Thread: any
  void arm() noexcept { wanted_ = true; }
  /// Stops watching, before ticks are stopped on purpose. Does not wait for an action under way.
  /// Thread: any
  void disarm() noexcept { wanted_ = false; }
  /// False after it acted. Realtime: yes. Thread: any
  bool isArmed() const noexcept { return wanted_; }

  /// Realtime: yes. Thread: any
  WatchdogReading reading() const noexcept {
    return {bites_, silence_ns_, machine_stalls_, longest_stall_ns_};
  }

 private:
  void setUpThread(int priority);
  void run(const WatchdogOptions& options) noexcept;

  const std::atomic<std::int64_t>& ticks_;
  Bite bite_;
  std::thread thread_;
  std::string warning_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> wanted_{false};
  std::atomic<std::int64_t> bites_{0};
  std::atomic<std::int64_t> silence_ns_{0};
  std::atomic<std::int64_t> machine_stalls_{0};
  std::atomic<std::int64_t> longest_stall_ns_{0};
};

}  // namespace ergotic::tgr
