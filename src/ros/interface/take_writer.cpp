// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/take_writer.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <rosbag/bag.h>

#include "ergotic/exception.hpp"

namespace ergotic::node {
namespace {

constexpr std::size_t kMaxWaiting = 10'000;  // blocks of gestures: some minutes

/// Time stamp of a message. A simulated clock may be at 0, which a bag cannot store.
::ros::Time timeOfMessage() {
  return std::max(::ros::Time::now(), ::ros::TIME_MIN);
}

}  // namespace

TakeWriter::TakeWriter(std::string path) : path_(std::move(path)), active_(path_ + ".active") {
  std::error_code ignored;  // opening it says what is wrong
  if (std::filesystem::exists(active_, ignored)) {
    throw Exception(
        active_ +
        " was left by a station that was killed: run `rosbag reindex` on it and give it a "
        "name that ends in .bag, or remove it, or choose another name");
  }
  try {
    bag_ = bag::openToWrite(active_);
  } catch (const rosbag::BagException& error) {
    throw Exception(active_ + ": cannot be written (" + error.what() + ")");
  }
  thread_ = std::thread([this] { run(); });
}

TakeWriter::~TakeWriter() {
  end();
  thread_.join();
}

template <class Message>
void TakeWriter::enqueue(const std::string& topic, const Message& message) {
  const auto copy = std::make_shared<const Message>(message);
  const ::ros::Time time = timeOfMessage();
  {
    const std::lock_guard lock(mutex_);
    if (work_.size() >= kMaxWaiting) {
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

void TakeWriter::write(const std::string& topic, const Hold& message) {
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

void TakeWriter::end() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  woken_.notify_one();
}

std::optional<std::string> TakeWriter::outcome() {
  const std::lock_guard lock(mutex_);
  return outcome_;
}

void TakeWriter::run() {
  while (writeWhatWaits()) {
  }
  std::string outcome = close();
  const std::lock_guard lock(mutex_);
  outcome_ = std::move(outcome);
}

/// \return false once there is nothing more. After a failure the rest is dropped
bool TakeWriter::writeWhatWaits() {
  std::deque<Work> work;
  bool is_good = false;
  {
    std::unique_lock lock(mutex_);
    woken_.wait(lock, [this] { return ends_ || !work_.empty(); });
    work.swap(work_);
    is_good = trouble_.empty();
  }
  try {
    for (const Work& write : work) {
      if (is_good) {
        write(*bag_);
      }
    }
  } catch (const std::exception& failure) {  // nothing may end the process while there is force
    const std::lock_guard lock(mutex_);
    trouble_ = failure.what();
  }
  return !work.empty();
}

/// \return why the take is not there, or an empty text
std::string TakeWriter::close() {
  std::string problem = trouble();
  try {
    bag_->close();
  } catch (const std::exception& failure) {
    problem = problem.empty() ? failure.what() : problem;
  }
  std::error_code error;
  if (!(seconds_ > 0.0)) {
    std::filesystem::remove(active_, error);
    return path_ + (has_keyframe_ ? ": nothing was played in it, so it is not kept"
                                  : ": the state of this model could not be taken, so nobody could "
                                    "play the take again. Begin it while there is no force");
  }
  if (!problem.empty()) {
    return active_ + ": could not be written to its end (" + problem + ")";
  }
  std::filesystem::rename(active_, path_, error);
  return error ? path_ + ": " + error.message() + "; the take is " + active_ : "";
}

}  // namespace ergotic::node
