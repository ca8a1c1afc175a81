// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/urgent_spinner.hpp"

#include <chrono>
#include <cstdint>
#include <utility>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "ergotic/rt/urgency.hpp"

namespace ergotic::node {

namespace {

/// Real-time priority of one thread, which calls `follow` again and again. Others may do so for the
/// same one.
class Priority {
 public:
  explicit Priority(int priority) : priority_(priority) {}

  void follow() {
    const bool is_urgent = rt::realtimePriority() > 0;
    const bool may_be = priority_ > 0 && urgency_.allows(rt::monotonicNs(), rt::threadCpuNs());
    if (may_be && !is_urgent && !is_refused_) {
      is_refused_ = !rt::makeRealtime(priority_).ok;
    } else if (!may_be && is_urgent) {
      rt::makeOrdinary();
    }
  }

 private:
  int priority_;
  rt::Urgency urgency_;
  bool is_refused_ = false;
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

constexpr std::chrono::milliseconds kLastLook{300};  // of a thread that looks every 100 ms

}  // namespace

UrgentSpinner::UrgentSpinner(::ros::CallbackQueue& queue,
                             int priority,
                             std::function<void()> look,
                             ::ros::WallDuration period)
    : queue_(queue), look_(std::move(look)), period_(period) {
  if (priority > 0) {
    // Called each time that thread has looked at its sockets, ten times a second at least.
    reader_ = std::make_shared<Reader>();
    sockets_ = ::ros::PollManager::instance()->addPollThreadListener(
        [reader = reader_, own = Priority(priority), pause = Pause()]() mutable {
          if (!reader->ends) {
            own.follow();
            pause.takeIfOften();
          } else if (!reader->has_ended) {
            rt::makeOrdinary();
            reader->has_ended = true;
            reader->ended.set_value();
          }
        });
  }
  thread_ = std::thread([this, priority] { run(priority); });
}

UrgentSpinner::~UrgentSpinner() {
  ends_ = true;
  if (reader_) {
    // It outlives this station, and would stay urgent with nobody to see how much it takes. Where
    // ROS has shut down it looks no more.
    reader_->ends = true;
    (void)reader_->ended.get_future().wait_for(kLastLook);
    ::ros::PollManager::instance()->removePollThreadListener(sockets_);
  }
  thread_.join();
}

void UrgentSpinner::run(int priority) {
  Priority own(priority);
  while (!ends_) {
    own.follow();
    look_();
    queue_.callAvailable(period_);
  }
}

}  // namespace ergotic::node
