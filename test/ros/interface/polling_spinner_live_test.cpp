// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/polling_spinner.hpp"

#include <functional>
#include <future>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;

class Call : public ::ros::CallbackInterface {
 public:
  explicit Call(std::function<void()> call) : call_(std::move(call)) {}
  CallResult call() override {
    call_();
    return Success;
  }

 private:
  std::function<void()> call_;
};

TEST(PollingSpinnerTest, ServesACallWhileAnotherWaits) {
  if (std::thread::hardware_concurrency() < 2) {
    GTEST_SKIP() << "one processor, so one thread";
  }
  ::ros::CallbackQueue queue;
  PollingSpinner spinner(queue);
  std::promise<void> second_is_there;
  std::promise<bool> first_saw_it;
  queue.addCallback(::ros::CallbackInterfacePtr(new Call([&] {
    first_saw_it.set_value(second_is_there.get_future().wait_for(30s) == std::future_status::ready);
  })));
  queue.addCallback(::ros::CallbackInterfacePtr(new Call([&] { second_is_there.set_value(); })));
  std::future<bool> saw = first_saw_it.get_future();
  EXPECT_EQ(saw.wait_for(50ms), std::future_status::timeout) << "it serves before it is started";
  spinner.start();
  EXPECT_TRUE(saw.get());
}

TEST(PollingSpinnerTest, EndsAfterTheCallThatIsServed) {
  ::ros::CallbackQueue queue;
  std::promise<void> begun;
  std::atomic<bool> is_done{false};
  {
    PollingSpinner spinner(queue);
    spinner.start();
    queue.addCallback(::ros::CallbackInterfacePtr(new Call([&] {
      begun.set_value();
      std::this_thread::sleep_for(20ms);
      is_done = true;
    })));
    begun.get_future().wait();
  }
  EXPECT_TRUE(is_done);
}

}  // namespace
}  // namespace ergotic::node
