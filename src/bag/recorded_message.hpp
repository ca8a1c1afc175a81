// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/bag/recording.hpp"
#include "ergotic/tgr/gesture.hpp"

/// Reader of bags, behind the library that opens them.
namespace ergotic::bag {

struct RecordedMessage {
  std::string type;
  std::string md5;  ///< MD5 sum of the type's definition
  std::vector<std::uint8_t> data;
};

/// Adds a message of a station; other messages are ignored.
/// \param path  of the bag, for messages
/// \throws Exception if it is cut short, or holds what no station can have recorded
void add(Recording& recording, RecordedMessage& message, const std::string& path);

/// Puts everything in the order of ticks. \throws Exception if it is no whole performance
void finish(Recording& recording, const std::string& path);

/// Reads positions as `readPositions`, each when it is needed. Realtime: no
/// \throws Exception as `readPositions`
std::unique_ptr<tgr::GestureSource> positionsOf(Recording recording, const std::string& path);

}  // namespace ergotic::bag
