// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/take_index.hpp"

#include <algorithm>
#include <utility>

#include <ergotic/GestureBlock.h>
#include <ergotic/Status.h>
#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bag/open_bag.hpp"

namespace ergotic::node {

TakeDetails detailsOf(const std::string& path) {
  TakeDetails details;
  try {
    const bag::BagPointer bag = bag::openToRead(path);
    rosbag::View blocks(*bag,
                        rosbag::TypeQuery(::ros::message_traits::DataType<GestureBlock>::value()));
    if (blocks.size() > 0) {
      details.began_ns = static_cast<std::int64_t>(blocks.getBeginTime().toNSec());
      details.length_s = (blocks.getEndTime() - blocks.getBeginTime()).toSec();
    }
    rosbag::View status(*bag, rosbag::TypeQuery(::ros::message_traits::DataType<Status>::value()));
    for (const rosbag::MessageInstance& message : status) {
      if (const auto told = message.instantiate<Status>(); told && !told->model.empty()) {
        details.instrument = told->model;
        break;
      }
    }
  } catch (const std::exception&) {  // replaying it says what is wrong with it
  }
  return details;
}

TakeIndex::TakeIndex() : thread_([this] { run(); }) {}

TakeIndex::~TakeIndex() {
  {
    const std::lock_guard lock(mutex_);
    quits_ = true;
  }
  woken_.notify_one();
  thread_.join();
}

std::optional<TakeDetails> TakeIndex::at(const TakeFile& take) {
  {
    const std::lock_guard lock(mutex_);
    const auto [entry, is_new] = entries_.try_emplace(take.path);
    if (!is_new && entry->second.written_ns == take.written_ns) {
      return entry->second.details;
    }
    entry->second = {take.written_ns, std::nullopt};
  }
  woken_.notify_one();
  return std::nullopt;
}

bool TakeIndex::hasNews() {
  const std::lock_guard lock(mutex_);
  return std::exchange(has_news_, false);
}

/// \return the path of a take that is to be read; empty: it ends
std::string TakeIndex::next() {
  std::unique_lock lock(mutex_);
  std::string path;
  woken_.wait(lock, [this, &path] {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [](const auto& entry) { return !entry.second.details; });
    path = found == entries_.end() ? "" : found->first;
    return quits_ || !path.empty();
  });
  return quits_ ? "" : path;
}

void TakeIndex::run() {
  for (std::string path = next(); !path.empty(); path = next()) {
    TakeDetails details = detailsOf(path);
    const std::lock_guard lock(mutex_);
    entries_[path].details = std::move(details);
    has_news_ = true;
  }
}

}  // namespace ergotic::node
