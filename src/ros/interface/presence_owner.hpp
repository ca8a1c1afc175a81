// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

namespace ergotic::node {

/// Of all who publish `presence` one counts: who spoke first. Another one has to be accepted, by
/// `recover`, and only once the first is silent: a forgotten publisher must not hold the switch for
/// a dead one, nor take it from one who lives. Times are of CLOCK_MONOTONIC. Thread: any
class PresenceOwner {
 public:
  static constexpr std::int64_t kSilentNs = 200'000'000;  ///< as long a switch counts that was held

  /// \return whether this publisher counts
  bool hears(const std::string& publisher, std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    name_ = name_.empty() ? publisher : name_;
    heard_ns_ = name_ == publisher ? now_ns : heard_ns_;
    return name_ == publisher;
  }
  /// Who speaks next counts, unless who counts has spoken just now.
  void acceptAnother(std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    if (now_ns - heard_ns_ > kSilentNs) {
      name_.clear();
    }
  }
  /// Empty: nobody yet.
  std::string name() const {
    const std::lock_guard lock(mutex_);
    return name_;
  }

 private:
  mutable std::mutex mutex_;
  std::string name_;
  std::int64_t heard_ns_ = 0;
};

}  // namespace ergotic::node
