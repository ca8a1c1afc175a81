// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace ergotic::node {

/// When failures are no chance any more: two in a row.
class RepeatedFailure {
 public:
  /// \return whether this one and the one before failed
  bool note(bool failed) noexcept {
    failures_ = failed ? std::min(failures_ + 1, kEnough) : 0;
    return failures_ == kEnough;
  }

 private:
  static constexpr int kEnough = 2;
  int failures_ = 0;
};

/// Asks the ROS master twice a second, in a thread of its own, where a service is that ends force:
/// when the master is gone, hangs for two seconds, or is a new one that never heard of us, nobody
/// can call the service any more.
class MasterWatch {
 public:
  /// \param service  full name, advertised
  /// \param on_lost  called from the watch's own thread when the master failed twice in a row, and
  ///                 again each time that it does
  MasterWatch(std::string service, std::function<void()> on_lost);
  ~MasterWatch();  ///< does not wait for an answer
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// Whether the last question failed. Thread: any
  bool isMissing() const noexcept { return missing_; }

 private:
  void run();
  bool masterKnows();
  bool stopped();

  std::string service_;
  std::function<void()> on_lost_;
  std::mutex mutex_;  // of stop_
  std::condition_variable woken_;
  bool stop_ = false;
  std::atomic<bool> missing_{false};
  std::thread thread_;
};

}  // namespace ergotic::node
