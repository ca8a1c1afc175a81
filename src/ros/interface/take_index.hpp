// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "ros/interface/take_folder.hpp"

namespace ergotic::node {

/// Details that only the bag of a take contains.
struct TakeDetails {
  std::int64_t began_ns = 0;  ///< time since 1970; 0: not known
  double length_s = 0.0;      ///< 0: not known
  std::string instrument;     ///< empty: not known
};

/// \return empty details for a file that is no bag, or is damaged. Thread: any
TakeDetails detailsOf(const std::string& path);

/// Looks into bags, in a thread of its own: a disk may take its time.
/// Thread: one, any; none of these waits, but the destructor, for a bag that is read
class TakeIndex {
 public:
  TakeIndex();
  ~TakeIndex();
  TakeIndex(const TakeIndex&) = delete;
  TakeIndex& operator=(const TakeIndex&) = delete;

  /// \return what is known of it; if nothing is, it is read, and `hasNews` says when that is done
  std::optional<TakeDetails> at(const TakeFile& take);
  /// Whether more is known than at the last call.
  bool hasNews();

 private:
  struct Entry {
    std::int64_t written_ns = 0;
    std::optional<TakeDetails> details;  // nothing: it is to be read
  };
  void run();
  std::string next();

  std::mutex mutex_;  // of what follows
  std::condition_variable woken_;
  std::map<std::string, Entry> entries_;  // by paths
  bool has_news_ = false;
  bool quits_ = false;
  std::thread thread_;
};

}  // namespace ergotic::node
