// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/station/messages.hpp"

/// What a rosbag of a station holds of a performance, as plain data.
namespace ergotic::bag {

/// Everything needed to run a model again from the start of tick `tick` on.
struct Keyframe {
  std::int64_t tick = 0;
  std::string scene_name;  ///< path or name it was read under
  std::string scene_text;
  std::string build;  ///< of the program that made the state
  physics::Rates rates;
  physics::Precision precision = physics::Precision::kFloat;
  std::string isa;      ///< name of the kernels' level (rt/isa.hpp); this processor may lack it
  int threads = 1;      ///< 1...physics::kMaxThreads
  bool metered = true;  ///< the state holds books of energy
  int slices = 0;       ///< of the device
  std::vector<std::uint8_t> state;
  std::vector<double> parameters;
};

/// Consecutive ticks.
struct Stretch {
  std::int64_t first_tick = 0;
  std::size_t slices = 0;
  std::size_t ports = 0;
  std::vector<std::uint32_t> flags;  ///< [ticks] station::GestureTick::Flag
  std::vector<double> positions;     ///< [ticks][slices] m, validated
  std::vector<double> ports_at;      ///< [ticks][ports] m, in the model, as the instrument got them

  std::int64_t endTick() const { return first_tick + static_cast<std::int64_t>(flags.size()); }
};

/// One performance. Each list is in the order of ticks.
struct Recording {
  std::vector<Keyframe> keyframes;
  std::vector<Stretch> stretches;
  std::vector<station::Event> events;  ///< without pointers: what changed the sound, and when
};

/// Reads the messages of a station, under whatever topic names, into memory.
/// \throws Exception if the file cannot be read, or holds no keyframe or no gesture
/// Realtime: no. Thread: any
Recording readRecording(const std::string& path);

}  // namespace ergotic::bag
