// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/urgent_spinner.hpp"

#include "ergotic/rt/thread.hpp"

namespace ergotic::node {

namespace {

const ::ros::WallDuration kLook(0.1);  // whether it ends

void makeUrgent(int priority) {
  if (rt::realtimePriority() < priority) {
    (void)rt::makeRealtime(priority);
  }
}

}  // namespace

UrgentSpinner::UrgentSpinner(::ros::CallbackQueue& queue, int priority) : queue_(queue) {
  if (priority > 0) {
    // Called whenever that thread has looked at its sockets, several times a second.
    sockets_ =
        ::ros::PollManager::instance()->addPollThreadListener([priority, tried = false]() mutable {
          if (!tried) {
            makeUrgent(priority);
          }
          tried = true;
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
