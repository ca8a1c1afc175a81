// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/station/messages.hpp"

/// Contents of a performance in a station's rosbag, as plain data.
namespace ergotic::bag {

/// State from which a model can be run again from the start of tick `tick` on.
struct Keyframe {
  std::int64_t tick = 0;
  std::string scene_name;  ///< path or name it was read under
  std::string scene_text;
  std::string build;  ///< build of the program that made the state
  physics::Rates rates;
  physics::Precision precision = physics::Precision::kFloat;
  std::string isa;      ///< name of the kernels' level (rt/isa.hpp); this processor may lack it
  int threads = 1;      ///< 1...physics::kMaxThreads
  bool metered = true;  ///< the state holds energy accounts
  int slices = 0;       ///< number of slices of the device
  std::vector<std::uint8_t> state;
  std::vector<double> parameters;
  std::string station_config;  ///< YAML: how the station was started
};

/// Consecutive ticks.
struct Stretch {
  std::int64_t first_tick = 0;
  std::size_t slices = 0;
  std::size_t ports = 0;
  std::vector<std::uint32_t> flags;  ///< [ticks] station::GestureTick::Flag
  std::vector<double> positions;     ///< [ticks][slices] m, validated
  std::vector<double> ports_at;      ///< [ticks][ports] m, in the model, as the instrument got them
  std::size_t block = 0;             ///< index for `Recording::load`

  /// Frees the positions with their memory, which a vector would keep if assigned `{}`.
  void forgetPositions() {
    positions = std::vector<double>();
    ports_at = std::vector<double>();
  }
  std::int64_t endTick() const { return first_tick + static_cast<std::int64_t>(flags.size()); }
};

/// One performance. Each list is in the order of ticks. An hour of twelve slices has two GB of
/// positions, so that stretches of a bag have theirs only from `load` to `unload`.
struct Recording {
  std::vector<Keyframe> keyframes;
  std::vector<Stretch> stretches;
  std::vector<station::Event> events;  ///< events that changed the sound, without pointers

  /// Loads the positions of a stretch; empty if all are loaded. \throws Exception
  std::function<void(Stretch&)> load;
  void unload(Stretch& stretch) const {
    if (load) {
      stretch.forgetPositions();
    }
  }
};

/// Reads and checks the messages of a station; positions are read again when they are needed.
/// \param station  name of its node; may be empty where the bag holds one station
/// \throws Exception if the file cannot be read, holds no keyframe or no gesture, or if it is not
///         said whose of several stations
/// Realtime: no. Thread: any
Recording readRecording(const std::string& path, const std::string& station = "");

}  // namespace ergotic::bag
