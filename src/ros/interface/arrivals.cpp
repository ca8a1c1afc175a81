// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/arrivals.hpp"

#include "ergotic/rt/clock.hpp"

namespace ergotic::node {
namespace {

[[gnu::tls_model("initial-exec")]] thread_local Arrival of_this_call;

class Noted : public ::ros::CallbackInterface {
 public:
  Noted(::ros::CallbackInterfacePtr inside, const Arrival& arrival)
      : inside_(std::move(inside)), arrival_(arrival) {}
  CallResult call() override {
    of_this_call = arrival_;
    return inside_->call();
  }
  bool ready() override { return inside_->ready(); }

 private:
  ::ros::CallbackInterfacePtr inside_;
  Arrival arrival_;
};

}  // namespace

void ArrivalQueue::addCallback(const ::ros::CallbackInterfacePtr& callback, std::uint64_t owner) {
  const Arrival now{rt::monotonicNs(), interlock_->ticket()};
  next_.addCallback(::ros::CallbackInterfacePtr(new Noted(callback, now)), owner);
}

const Arrival& ArrivalQueue::ofThisCall() {
  return of_this_call;
}

}  // namespace ergotic::node
