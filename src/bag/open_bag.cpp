// SPDX-License-Identifier: BSD-3-Clause
#include "bag/open_bag.hpp"

#include <mutex>

#include <rosbag/bag.h>

namespace ergotic::bag {
namespace {

std::mutex& pluginsMutex() {
  static std::mutex mutex;
  return mutex;
}

BagPointer open(const std::string& path, rosbag::BagMode mode) {
  const std::lock_guard lock(pluginsMutex());
  auto bag = std::make_unique<rosbag::Bag>();
  bag->open(path, mode);
  return BagPointer(bag.release());
}

}  // namespace

void CloseBag::operator()(rosbag::Bag* bag) const noexcept {
  const std::lock_guard lock(pluginsMutex());
  const std::unique_ptr<rosbag::Bag> freed(bag);
}

BagPointer openToRead(const std::string& path) {
  return open(path, rosbag::bagmode::Read);
}

BagPointer openToWrite(const std::string& path) {
  return open(path, rosbag::bagmode::Write);
}

}  // namespace ergotic::bag
