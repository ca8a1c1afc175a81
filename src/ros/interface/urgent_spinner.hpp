// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <thread>

#include <ros/callback_queue.h>
#include <ros/poll_manager.h>

namespace ergotic::node {

/// Serves a queue in a thread of its own that ordinary programs cannot keep from running, and lets
/// the thread that reads all sockets of this process be as urgent: on a machine with forty busy
/// programs a request waited for up to 1.3 s in front of an ordinary one. Both are as urgent as
/// that only while `rt::Urgency` allows it. Thread: the one that makes it
class UrgentSpinner {
 public:
  /// \param priority  SCHED_FIFO, 1...99, below that of the ticks; 0: ordinary threads. Where the
  ///   system refuses it both stay ordinary: the tick thread, which asks for more, warns of it
  /// \param look      called by the thread that serves the queue, at least once in `period`
  UrgentSpinner(::ros::CallbackQueue& queue,
                int priority,
                std::function<void()> look,
                ::ros::WallDuration period = ::ros::WallDuration(0.005));
  ~UrgentSpinner();
  UrgentSpinner(const UrgentSpinner&) = delete;
  UrgentSpinner& operator=(const UrgentSpinner&) = delete;

 private:
  /// State of the thread that reads the sockets, kept after this object has gone.
  struct Reader {
    std::atomic<bool> ends{false};
    std::promise<void> ended;  // it is ordinary again
    bool has_ended = false;    // its own
  };

  void run(int priority);

  ::ros::CallbackQueue& queue_;
  std::function<void()> look_;
  ::ros::WallDuration period_;
  std::atomic<bool> ends_{false};
  std::shared_ptr<Reader> reader_;  // none where nothing is urgent
  boost::signals2::connection sockets_;
  std::thread thread_;
};

}  // namespace ergotic::node
