// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <ros/callback_queue.h>

namespace ergotic::node {

/// Serves a queue in a thread per processor, as `ros::AsyncSpinner` does, but its threads look at
/// the queue every 5 ms, and do not wait for its condition variable. Where several threads wait for
/// one, who adds a call may have to wait in pthread_cond_signal of glibc 2.36 until a thread that
/// was woken before has got a processor, on a full machine for 0.1 s; and it is the thread that
/// reads all sockets, those of stops as well, who adds. Thread: the one that makes it
class PollingSpinner {
 public:
  /// \param queue  outlives this
  explicit PollingSpinner(::ros::CallbackQueue& queue) : queue_(queue) {}
  ~PollingSpinner() {
    ends_ = true;
    for (std::thread& thread : threads_) {
      thread.join();
    }
  }
  PollingSpinner(const PollingSpinner&) = delete;
  PollingSpinner& operator=(const PollingSpinner&) = delete;

  /// Call it once.
  void start() {
    const unsigned count = std::max(std::thread::hardware_concurrency(), 1U);
    for (unsigned i = 0; i < count; ++i) {
      threads_.emplace_back([this] { run(); });
    }
  }

 private:
  static constexpr std::chrono::milliseconds kPeriod{5};

  void run() {
    while (!ends_) {
      if (queue_.callOne() != ::ros::CallbackQueue::Called) {
        std::this_thread::sleep_for(kPeriod);
      }
    }
  }

  ::ros::CallbackQueue& queue_;
  std::atomic<bool> ends_{false};
  std::vector<std::thread> threads_;
};

}  // namespace ergotic::node
