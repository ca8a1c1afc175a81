// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Keyframe.h>
#include <ergotic/Parameters.h>
#include <ergotic/Status.h>

namespace rosbag {
class Bag;  // its header takes seconds to compile
}

namespace ergotic::node {

/// Writes what a station tells of a performance into a bag, in a thread of its own: a slow disk
/// delays nobody. The file has the ending `.active` until it is whole.
/// Thread: operator, all of it
class TakeWriter {
 public:
  /// \param path  of the bag, in a folder that exists
  /// \throws Exception if it cannot be written
  explicit TakeWriter(std::string path);
  ~TakeWriter();  ///< as `finish`
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;

  // Take over a message of a topic of the station; none of these waits.
  void write(const std::string& topic, const GestureBlock& message);
  void write(const std::string& topic, const Keyframe& message);
  void write(const std::string& topic, const Event& message);
  void write(const std::string& topic, const Status& message);
  void write(const std::string& topic, const ::ergotic::Parameters& message);

  const std::string& path() const { return path_; }
  /// Of what can be played again: from the first keyframe on. 0: nothing.
  double seconds() const { return seconds_; }
  /// \return what keeps it from being written; empty: nothing
  std::string trouble();

  /// Waits until all is written, and gives the file its name. A file that nobody could play again
  /// is removed. \throws Exception if it could not be written, or has nothing that can be played
  void finish();

 private:
  using Work = std::function<void(rosbag::Bag&)>;
  template <class Message>
  void enqueue(const std::string& topic, const Message& message);
  void run();

  std::string path_;
  std::string active_;  // path until it is whole
  std::unique_ptr<rosbag::Bag> bag_;
  bool has_keyframe_ = false;
  double seconds_ = 0.0;
  std::mutex mutex_;  // of what follows
  std::condition_variable woken_;
  std::deque<Work> work_;
  std::string trouble_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace ergotic::node
