// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/bag/recording.hpp"
#include "ergotic/tgr/gesture.hpp"

/// What reads a bag, behind the library that opens it.
namespace ergotic::bag {

struct RecordedMessage {
  std::string type;
  std::string md5;  ///< of its definition
  std::vector<std::uint8_t> data;
};

/// Adds a message of a station; any other is passed over.
/// \param path  of the bag, for messages
/// \throws Exception if it is cut short, or holds what no station can have recorded
void add(Recording& recording, RecordedMessage& message, const std::string& path);

/// Puts everything in the order of ticks. \throws Exception if it is no whole performance
void finish(Recording& recording, const std::string& path);

/// As `readPositions`, but none is read before it is asked for. Realtime: no
/// \throws Exception as `readPositions`
std::unique_ptr<tgr::GestureSource> positionsOf(Recording recording, const std::string& path);

}  // namespace ergotic::bag
