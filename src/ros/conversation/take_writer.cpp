// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/take_writer.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <ros/console.h>
#include <rosbag/bag.h>

#include "ergotic/exception.hpp"

namespace ergotic::node {
namespace {

constexpr std::size_t kMostWaiting = 10'000;  // blocks of gestures: some minutes

/// A clock that is simulated may stand at its beginning, which a bag has no place for.
::ros::Time timeOfMessage() {
  return std::max(::ros::Time::now(), ::ros::TIME_MIN);
}

}  // namespace

TakeWriter::TakeWriter(std::string path)
    : path_(std::move(path)), active_(path_ + ".active"), bag_(std::make_unique<rosbag::Bag>()) {
  try {
    bag_->open(active_, rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw Exception(active_ + ": cannot be written (" + error.what() + ")");
  }
  thread_ = std::thread([this] { run(); });
}

TakeWriter::~TakeWriter() {
  try {
    finish();
  } catch (const std::exception& failure) {
    ROS_ERROR_STREAM(failure.what());
  }
}

template <class Message>
void TakeWriter::enqueue(const std::string& topic, const Message& message) {
  const auto copy = std::make_shared<const Message>(message);
  const ::ros::Time time = timeOfMessage();
  {
    const std::lock_guard lock(mutex_);
    if (work_.size() >= kMostWaiting) {
      trouble_ = "the disk is too slow";
      return;
    }
    work_.emplace_back([=](rosbag::Bag& bag) { bag.write(topic, time, *copy); });
  }
  woken_.notify_one();
}

void TakeWriter::write(const std::string& topic, const GestureBlock& message) {
  enqueue(topic, message);
  seconds_ += has_keyframe_ ? message.ticks / message.tick_rate_hz : 0.0;
}

void TakeWriter::write(const std::string& topic, const Keyframe& message) {
  enqueue(topic, message);
  has_keyframe_ = true;
}

void TakeWriter::write(const std::string& topic, const Event& message) {
  enqueue(topic, message);
}

void TakeWriter::write(const std::string& topic, const Status& message) {
  enqueue(topic, message);
}

void TakeWriter::write(const std::string& topic, const ::ergotic::Parameters& message) {
  enqueue(topic, message);
}

std::string TakeWriter::trouble() {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

void TakeWriter::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    woken_.wait(lock, [this] { return is_over_ || !work_.empty(); });
    std::deque<Work> work;
    work.swap(work_);
    if (work.empty()) {
      return;
    }
    const bool goes_on = trouble_.empty();
    lock.unlock();
    std::string trouble;
    try {
      for (const Work& write : work) {
        if (goes_on) {
          write(*bag_);
        }
      }
    } catch (const rosbag::BagException& error) {
      trouble = error.what();
    }
    lock.lock();
    trouble_ = trouble.empty() ? trouble_ : trouble;
  }
}

void TakeWriter::finish() {
  if (!thread_.joinable()) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  woken_.notify_one();
  thread_.join();
  try {
    bag_->close();
  } catch (const rosbag::BagException& error) {
    trouble_ = trouble_.empty() ? error.what() : trouble_;
  }
  std::error_code error;
  if (!(seconds_ > 0.0)) {
    std::filesystem::remove(active_, error);
    throw Exception(path_ + (has_keyframe_
                                 ? ": nothing was played in it, so it is not kept"
                                 : ": the state of this model could not be taken, so nobody could "
                                   "play the take again. Begin it while there is no force"));
  }
  if (!trouble_.empty()) {
    throw Exception(active_ + ": could not be written to its end (" + trouble_ + ")");
  }
  std::filesystem::rename(active_, path_, error);
  if (error) {
    throw Exception(path_ + ": " + error.message() + "; the take is " + active_);
  }
}

}  // namespace ergotic::node
