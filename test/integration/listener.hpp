// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <thread>

#include <ros/node_handle.h>

#include "support/test.hpp"

namespace ergotic::test {

/// Waits until something holds, without saying how fast it must. \return false after `seconds`
template <class Condition>
bool eventually(const Condition& condition, double seconds = 30.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

/// Keeps every message of a topic. \pre a spinner runs
template <class Message>
class Listener {
 public:
  Listener(::ros::NodeHandle& node, const std::string& topic) {
    subscriber_ = node.subscribe<Message>(topic, 10000, [this](const auto& message) {
      const std::lock_guard lock(mutex_);
      messages_.push_back(*message);
    });
  }

  std::vector<Message> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }
  std::size_t count() const {
    const std::lock_guard lock(mutex_);
    return messages_.size();
  }
  Message latest() const {
    const std::lock_guard lock(mutex_);
    return messages_.empty() ? Message() : messages_.back();
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Message> messages_;
  ::ros::Subscriber subscriber_;
};

}  // namespace ergotic::test
