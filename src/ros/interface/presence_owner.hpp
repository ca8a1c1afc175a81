// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

namespace ergotic::node {

/// Selects the publisher of `presence` that counts: the first one. Another publisher has to be
/// accepted, by `recover`, and only once the first is silent: a forgotten publisher can neither
/// hold the deadman switch for a dead one, nor take it from a live one. Times are of
/// CLOCK_MONOTONIC. Thread: any
class PresenceOwner {
 public:
  static constexpr std::int64_t kSilentNs = 200'000'000;  ///< validity of a message

  /// \return whether this publisher counts
  bool hears(const std::string& publisher, std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    name_ = name_.empty() ? publisher : name_;
    heard_ns_ = name_ == publisher ? now_ns : heard_ns_;
    return name_ == publisher;
  }
  /// Lets the next publisher count, unless the present one has just sent a message.
  void acceptAnother(std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    if (now_ns - heard_ns_ > kSilentNs) {
      name_.clear();
    }
  }
  /// Name of the publisher that counts; empty: none yet.
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
