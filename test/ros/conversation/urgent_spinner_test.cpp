// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/urgent_spinner.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include <ros/poll_manager.h>
#include <sys/epoll.h>

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

TEST(UrgentSpinnerTest, LeavesTheProcessorToWhoeverHoldsAConnection) {
  const auto polls = ::ros::PollManager::instance();
  polls->start();
  ::ros::CallbackQueue queue;
  const UrgentSpinner spinner(queue, kPriority);
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
