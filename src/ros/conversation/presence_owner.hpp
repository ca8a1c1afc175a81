// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <string>

namespace ergotic::node {

/// Of all who publish `presence` one counts: who spoke first. Another one has to be accepted, by
/// `recover`: a forgotten publisher must not hold the switch for a dead one. Thread: any
class PresenceOwner {
 public:
  /// \return whether this publisher counts
  bool hears(const std::string& publisher) {
    const std::lock_guard lock(mutex_);
    name_ = name_.empty() ? publisher : name_;
    return name_ == publisher;
  }
  /// Who speaks next counts.
  void acceptAnother() {
    const std::lock_guard lock(mutex_);
    name_.clear();
  }
  /// Empty: nobody yet.
  std::string name() const {
    const std::lock_guard lock(mutex_);
    return name_;
  }

 private:
  mutable std::mutex mutex_;
  std::string name_;
};

}  // namespace ergotic::node
