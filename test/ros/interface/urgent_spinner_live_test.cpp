// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/urgent_spinner.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include <ros/poll_manager.h>
#include <sys/epoll.h>

#include "ergotic/rt/thread.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;

constexpr int kPriority = 40;

/// Something to read that nobody reads: what holds a connection waits for a processor.
class UnreadSocket {
 public:
  UnreadSocket() {
    EXPECT_EQ(pipe(ends_.data()), 0);
    EXPECT_EQ(write(ends_[1], "x", 1), 1);
    sockets().addSocket(ends_[0], [](int /*events*/) {});
    sockets().addEvents(ends_[0], EPOLLIN);
  }
  ~UnreadSocket() {
    sockets().delSocket(ends_[0]);
    for (const int end : ends_) {
      close(end);
    }
  }
  UnreadSocket(const UnreadSocket&) = delete;
  UnreadSocket& operator=(const UnreadSocket&) = delete;

 private:
  static ::ros::PollSet& sockets() { return ::ros::PollManager::instance()->getPollSet(); }
  std::array<int, 2> ends_{};
};

/// What the thread that reads the sockets is, by its own word, when it has looked twice more.
int priorityOfReader() {
  const auto polls = ::ros::PollManager::instance();
  std::promise<int> told;
  int looks = 0;
  const boost::signals2::connection asked = polls->addPollThreadListener([&] {
    if (++looks == 2) {
      told.set_value(rt::realtimePriority());
    }
  });
  const int priority = told.get_future().get();
  polls->removePollThreadListener(asked);
  return priority;
}

TEST(UrgentSpinnerTest, TheReaderOfSocketsIsUrgentAsLongAsSomebodyWantsIt) {
  if (!std::async(std::launch::async, [] { return rt::makeRealtime(1).ok; }).get()) {
    GTEST_SKIP() << "no real-time priority here";
  }
  const auto polls = ::ros::PollManager::instance();
  polls->start();
  ::ros::CallbackQueue queue;
  EXPECT_EQ(priorityOfReader(), 0);
  {
    const UrgentSpinner stays(queue, kPriority, [] {});
    {
      const UrgentSpinner goes(queue, kPriority, [] {});
      EXPECT_EQ(priorityOfReader(), kPriority);
    }
    EXPECT_EQ(priorityOfReader(), kPriority);
  }
  EXPECT_EQ(priorityOfReader(), 0);
  polls->shutdown();
}

TEST(UrgentSpinnerTest, LeavesTheProcessorToWhoeverHoldsAConnection) {
  const auto polls = ::ros::PollManager::instance();
  polls->start();
  ::ros::CallbackQueue queue;
  const UrgentSpinner spinner(queue, kPriority, [] {});
  std::atomic<int> looks{0};
  std::promise<void> looked;
  const boost::signals2::connection counted = polls->addPollThreadListener([&] {
    if (++looks == 100) {
      looked.set_value();
    }
  });
  {
    const UnreadSocket unread;
    EXPECT_EQ(looked.get_future().wait_for(30s), std::future_status::ready)
        << "it does not look again and again";
    const int before = looks;
    const auto from = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(300ms);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
    EXPECT_LT((looks - before) / seconds, 12'000.0) << "looks per second";
  }
  polls->removePollThreadListener(counted);
  polls->shutdown();
}

}  // namespace
}  // namespace ergotic::node
