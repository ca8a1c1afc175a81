// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Hold.h>
#include <ergotic/Keyframe.h>
#include <ergotic/Parameters.h>
#include <ergotic/Status.h>

#include "bag/open_bag.hpp"

namespace ergotic::node {

/// Writes the messages of a performance into a bag, in a thread of its own: a slow disk delays no
/// other thread. The file has the ending `.active` until it is whole; one that cannot be played
/// again is removed.
/// Thread: command thread, all of it
class TakeWriter {
 public:
  /// \param path  of the bag, in a folder that exists
  /// \throws Exception if it cannot be written, or was begun and not ended by another writer
  explicit TakeWriter(std::string path);
  ~TakeWriter();  ///< waits until it is over
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;

  // Take over a message of a topic of the station; none of these waits.
  void write(const std::string& topic, const GestureBlock& message);
  void write(const std::string& topic, const Keyframe& message);
  void write(const std::string& topic, const Event& message);
  void write(const std::string& topic, const Hold& message);
  void write(const std::string& topic, const Status& message);
  void write(const std::string& topic, const ::ergotic::Parameters& message);

  const std::string& path() const { return path_; }
  /// Duration that can be played again: from the first keyframe on. 0: nothing.
  double seconds() const { return seconds_; }
  /// \return error that prevents writing; empty: none
  std::string trouble();

  /// Ends the take: waiting messages are written, and the file gets its name.
  void end();
  /// \return nothing while that is done; then an error, or an empty text
  std::optional<std::string> outcome();

 private:
  using Work = std::function<void(rosbag::Bag&)>;
  template <class Message>
  void enqueue(const std::string& topic, const Message& message);
  void run();
  bool writeWhatWaits();
  std::string close();

  std::string path_;
  std::string active_;  // path until it is whole
  bag::BagPointer bag_;
  bool has_keyframe_ = false;
  double seconds_ = 0.0;
  std::mutex mutex_;  // of what follows
  std::condition_variable woken_;
  std::deque<Work> work_;
  std::string trouble_;
  bool ends_ = false;
  std::optional<std::string> outcome_;
  std::thread thread_;
};

}  // namespace ergotic::node
