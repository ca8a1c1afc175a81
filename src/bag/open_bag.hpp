// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

namespace rosbag {
class Bag;  // its header takes seconds to compile
}

namespace ergotic::bag {

/// Closes a bag and frees it. Thread: any
struct CloseBag {
  void operator()(rosbag::Bag* bag) const noexcept;
};

using BagPointer = std::unique_ptr<rosbag::Bag, CloseBag>;

/// Opens a bag; one that is written begins anew. Every bag loads a plugin (for encryption, even if
/// there is none), and the process crashes in class_loader where two threads load or unload plugins
/// at once: so bags are opened and freed one after another, within the whole process. Reading and
/// writing need no such care, one thread for each bag. Thread: any \throws rosbag::BagException
BagPointer openToRead(const std::string& path);
BagPointer openToWrite(const std::string& path);

}  // namespace ergotic::bag
