// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <future>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

struct GuardianPage;

struct GuardianOptions {
  double silence_s = 0.04;  ///< without a beat before it acts, 0.008...2
  int priority = 80;        ///< SCHED_FIFO of the guardian, 1...99; 0: an ordinary process
};

/// A small process that outlives this one. When this process ends or hangs, the guardian takes the
/// force off the devices, with the data that it holds of them (Driver::guards).
///
/// The kernel reports the end of this process to the guardian at once; a hang shows as missing
/// heartbeats. Time in which the guardian itself did not run does not count as silence. The
/// guardian has a session of its own, so that no signal of a terminal reaches it, and ends by
/// itself.
class Guardian {
 public:
  /// Returns when the guardian holds all of them. Realtime: no. Thread: setup
  /// \throws DeviceError saying what it cannot hold, or that there is no such program
  Guardian(const std::vector<Guard>& guards, const GuardianOptions& options);
  /// Ends the guardian without touching a device. \pre the devices were given back
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// Heartbeat of this process: at least four per `silence_s`, from the first one on.
  /// Realtime: yes. Thread: any
  void beat() noexcept;
  /// Returns false once the guardian has died, or has not looked during eight of these calls, as
  /// when it was stopped; it is ended then. Call every eighth of `silence_s`, so that this takes a
  /// whole `silence_s`. Time in which this process could not ask is not counted against the
  /// guardian. Realtime: no. Thread: one
  bool isWatching() noexcept;
  pid_t pid() const noexcept { return pid_; }

 private:
  void hold(int priority);
  void waitForAnswer(const std::string& program);
  void end() noexcept;

  GuardianPage* page_ = nullptr;
  std::promise<void> done_;
  std::thread holder_;  // of the page's lock
  pid_t pid_ = -1;
  bool is_told_ = false;     // of faults
  std::int64_t looks_ = -1;  // of the guardian, as of the last call of isWatching
  int asked_ = 0;            // since they were others
};

}  // namespace ergotic::tgr
