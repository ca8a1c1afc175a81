// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/urgent_spinner.hpp"

#include <cstdint>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "ergotic/rt/urgency.hpp"

namespace ergotic::node {

namespace {

const ::ros::WallDuration kLook(0.1);  // whether it ends

/// Of one thread, which asks for it again and again.
class Priority {
 public:
  explicit Priority(int priority) : priority_(priority) {}

  void follow() {
    const bool is_urgent = priority_ > 0 && urgency_.allows(rt::monotonicNs(), rt::threadCpuNs());
    if (is_urgent && !was_urgent_) {
      (void)rt::makeRealtime(priority_);
    } else if (!is_urgent && was_urgent_) {
      rt::makeOrdinary();
    }
    was_urgent_ = is_urgent;
  }

 private:
  int priority_;
  rt::Urgency urgency_;
  bool was_urgent_ = false;
};

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
    // Called each time that thread has looked at its sockets, ten times a second at least.
    sockets_ = ::ros::PollManager::instance()->addPollThreadListener(
        [own = Priority(priority), pause = Pause()]() mutable {
          own.follow();
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
  Priority own(priority);
  while (!ends_) {
    own.follow();
    queue_.callAvailable(kLook);
  }
}

}  // namespace ergotic::node
