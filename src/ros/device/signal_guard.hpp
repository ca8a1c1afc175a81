// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

namespace ergotic::node {

/// Runs `on_signal` in an ordinary thread when SIGINT, SIGTERM or SIGHUP arrives, then lets the
/// signal do what it would have done without us, so that the process ends with its usual status.
///
/// Debian's nodelet manager ends on SIGTERM and SIGHUP without any destructor; this is how forces
/// still go to zero. The handler writes one byte to a pipe, nothing else. Several guards may live
/// in one process (several stations in one manager): all are called, none waits for another.
class SignalGuard {
 public:
  /// \param on_signal  called at most once, from the helper thread; must return within a second
  /// \throws DeviceError if the system has no pipe or thread left
  explicit SignalGuard(std::function<void()> on_signal);
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

 private:
  class Pipe;
  std::function<void()> on_signal_;
  std::shared_ptr<Pipe> pipe_;
};

}  // namespace ergotic::node
