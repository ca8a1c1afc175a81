// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "ergotic/tgr/gesture.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "scene/limits.hpp"
#include "tgr/drivers/virtual/in_process_driver.hpp"
#include "tgr/drivers/virtual/shared_memory_driver.hpp"
#include "tgr/drivers/virtual/target_gesture.hpp"

namespace ergotic::tgr {
namespace {

std::string listOf(const std::vector<int>& slices) {
  std::string list;
  for (const int slice : slices) {
    list += (list.empty() ? "" : ", ") + std::to_string(slice);
  }
  return list;
}

/// Describes a target of a slice beyond its end stops; empty if there is none.
std::string beyondStops(const VirtualDriverConfig& config,
                        int slice,
                        const TargetGesture::Range& range) {
  const auto other = config.others.find(slice);
  const double stop_m = other == config.others.end() ? config.slice.stop : other->second.stop;
  const double farthest_m = -range.lowest_m > range.highest_m ? range.lowest_m : range.highest_m;
  return std::abs(farthest_m) <= stop_m
             ? ""
             : "a target of slice " + std::to_string(slice) + " is " +
                   scene::numberText(farthest_m) + " m; the slice stops at +-" +
                   scene::numberText(stop_m) + " m, so the hand never gets there";
}

}  // namespace

std::unique_ptr<Driver> makeVirtualDriver(const VirtualDriverConfig& config) {
  if (config.shared_memory.empty()) {
    return std::make_unique<InProcessDriver>(config);
  }
  return std::make_unique<SharedMemoryDriver>(config);
}

std::vector<std::string> gestureWarnings(const VirtualDriverConfig& config,
                                         std::uint64_t slices_in_use,
                                         double seconds,
                                         double late_s) {
  const std::string start = config.gesture_file + ": warning: ";
  if (gestureKindOf(config.gesture_file) == GestureKind::kPositions) {
    return {};
  }
  const TargetGesture gesture = readTargetGesture(config.gesture_file, config.slices);
  const std::vector<GestureValue> values = readGestureValues(config.gesture_file);
  std::vector<std::string> warnings;
  std::vector<int> idle;
  double last_s = values.empty() ? 0.0 : values.back().time_s;
  bool is_empty = values.empty();
  for (int i = 0; i < config.slices; ++i) {
    const TargetGesture::Range range = gesture.rangeOf(i);
    if (range.is_empty) {
      continue;
    }
    is_empty = false;
    last_s = std::max(last_s, range.last_s);
    if ((slices_in_use >> static_cast<unsigned>(i) & 1U) == 0) {
      idle.push_back(i);
    }
    if (const std::string beyond = beyondStops(config, i, range); !beyond.empty()) {
      warnings.push_back(start + beyond);
    }
  }
  if (is_empty) {
    warnings.push_back(start + "the file has no rows, so the hands rest at 0");
  }
  if (!idle.empty()) {
    warnings.push_back(start + "it moves " + (idle.size() == 1 ? "slice " : "slices ") +
                       listOf(idle) + ", which no port of the scene follows");
  }
  if (last_s > seconds + late_s) {
    warnings.push_back(start + "the gesture ends " + scene::numberText(last_s - seconds) +
                       " s after the render does, at " + scene::numberText(last_s) +
                       " s; times are in seconds, and --seconds says how long is played");
  }
  return warnings;
}

}  // namespace ergotic::tgr
