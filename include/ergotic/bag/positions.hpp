// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/gesture.hpp"

namespace ergotic::bag {

/// Positions of the slices, tick by tick, as a bag of a station recorded them, read ahead.
/// Over ticks that never ran the last position is held.
/// \param station  as of `readRecording`
/// \throws Exception as `readRecording`, or if the number of slices changes on the way
std::unique_ptr<tgr::GestureSource> readPositions(const std::string& path,
                                                  const std::string& station = "");

}  // namespace ergotic::bag
