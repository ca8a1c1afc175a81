// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/arrivals.hpp"

#include <functional>
#include <thread>

#include <ros/callback_queue.h>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

class Callback : public ::ros::CallbackInterface {
 public:
  explicit Callback(std::function<void()> act) : act_(std::move(act)) {}
  CallResult call() override {
    act_();
    return Success;
  }

 private:
  std::function<void()> act_;
};

class ArrivalQueueTest : public ::testing::Test {
 protected:
  void add(std::function<void()> act, std::uint64_t owner = 0) {
    arrivals_.addCallback(::ros::CallbackInterfacePtr(new Callback(std::move(act))), owner);
  }
  std::shared_ptr<station::Interlock> interlock_ = std::make_shared<station::Interlock>();
  ::ros::CallbackQueue queue_;
  ArrivalQueue arrivals_{queue_, interlock_};
};

TEST_F(ArrivalQueueTest, ACallThatWaitedKnowsOfNoStopThatCameMeanwhile) {
  bool engaged = true;
  add([&] { engaged = interlock_->engage(ArrivalQueue::ofThisCall().ticket); });
  interlock_->stop();
  queue_.callAvailable();
  EXPECT_FALSE(engaged);
  add([&] { engaged = interlock_->engage(ArrivalQueue::ofThisCall().ticket); });
  queue_.callAvailable();
  EXPECT_TRUE(engaged) << "asked for later";
}

TEST_F(ArrivalQueueTest, NotesWhenACallCameNotWhenItIsServed) {
  std::vector<std::int64_t> times;
  for (int i = 0; i < 2; ++i) {
    add([&] { times.push_back(ArrivalQueue::ofThisCall().time_ns); });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  queue_.callAvailable();
  ASSERT_EQ(times.size(), 2U);
  EXPECT_GE(times[1] - times[0], 20'000'000);
}

TEST_F(ArrivalQueueTest, ForgetsCallsWhoseServiceIsGone) {
  bool called = false;
  add([&] { called = true; }, 7);
  arrivals_.removeByID(7);
  queue_.callAvailable();
  EXPECT_FALSE(called);
}

}  // namespace
}  // namespace ergotic::node
