// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/urgent_spinner.hpp"

#include <cstdint>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::node {

namespace {

const ::ros::WallDuration kLook(0.1);  // whether it ends

void makeUrgent(int priority) {
  if (rt::realtimePriority() < priority) {
    (void)rt::makeRealtime(priority);
  }
}

/// roscpp looks at a socket again and again as long as another thread holds its connection, which
/// on a full machine may be an ordinary one that waits for the processor of this urgent one.
class Pause {
 public:
  void takeIfOften() {
    const std::int64_t now_ns = rt::monotonicNs();
    if (now_ns - last_ns_ < kPauseNs) {
      rt::sleepUntilNs(now_ns + kPauseNs);
    }
    last_ns_ = rt::monotonicNs();
  }

 private:
  static constexpr std::int64_t kPauseNs = 100'000;
  std::int64_t last_ns_ = 0;
};

}  // namespace

UrgentSpinner::UrgentSpinner(::ros::CallbackQueue& queue, int priority) : queue_(queue) {
  if (priority > 0) {
    // Called whenever that thread has looked at its sockets, several times a second.
    sockets_ = ::ros::PollManager::instance()->addPollThreadListener(
        [priority, tried = false, pause = Pause()]() mutable {
          if (!tried) {
            makeUrgent(priority);
          }
          tried = true;
          pause.takeIfOften();
        });
  }
  thread_ = std::thread([this, priority] { run(priority); });
}

UrgentSpinner::~UrgentSpinner() {
  ends_ = true;
  thread_.join();
  ::ros::PollManager::instance()->removePollThreadListener(sockets_);
}

void UrgentSpinner::run(int priority) {
  makeUrgent(priority);
  while (!ends_) {
    queue_.callAvailable(kLook);
  }
}

}  // namespace ergotic::node
