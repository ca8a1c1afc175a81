// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

namespace ergotic::node {

/// Makes safe and closes, in a thread of its own, when SIGINT, SIGTERM or SIGHUP arrives, then lets
/// the signal do what it would have done without us, so that the process ends with its usual
/// status.
///
/// Debian's nodelet manager ends on SIGTERM and SIGHUP without any destructor; this is how forces
/// still go to zero. The handler writes one byte to a pipe, nothing else. Several guards may live
/// in one process (several stations in one manager): all are made safe before any is closed.
class SignalGuard {
 public:
  /// Both are called at most once, from the helper thread.
  /// \param make_safe  returns at once
  /// \param close      returns within a second
  /// \throws DeviceError if the system has no pipe or thread left
  SignalGuard(std::function<void()> make_safe, std::function<void()> close);
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

 private:
  class Pipe;
  std::function<void()> make_safe_;
  std::function<void()> close_;
  std::shared_ptr<Pipe> pipe_;
};

}  // namespace ergotic::node
