// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace ergotic::node {

/// Processes news in a thread of its own. The sender never waits for that: news that arrive
/// meanwhile are merged, and processed together.
template <class News>
class Newest {
 public:
  /// \param act  gets all news since its last call. Thread: the own one
  explicit Newest(std::function<void(News&)> act)
      : act_(std::move(act)), thread_([this] { run(); }) {}
  /// Waits until it has acted on what it began with; the rest is forgotten.
  ~Newest() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
    }
    woken_.notify_all();
    thread_.join();
  }
  Newest(const Newest&) = delete;
  Newest& operator=(const Newest&) = delete;

  /// \param change  adds to a News that is not processed yet. Thread: any
  template <class Change>
  void tell(const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      change(waiting_);
      is_news_ = true;
    }
    woken_.notify_all();
  }

 private:
  void run() {
    News taken;
    while (take(taken)) {
      act_(taken);
    }
  }
  /// \return false if there shall be no more
  bool take(News& taken) {
    std::unique_lock lock(mutex_);
    woken_.wait(lock, [this] { return is_news_ || quit_; });
    std::swap(taken, waiting_);
    is_news_ = false;
    return !quit_;
  }

  std::function<void(News&)> act_;
  std::mutex mutex_;  // of what follows
  std::condition_variable woken_;
  News waiting_;
  bool is_news_ = false;
  bool quit_ = false;

  std::thread thread_;
};

}  // namespace ergotic::node
