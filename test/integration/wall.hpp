// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/reference_threads.hpp"
#include "support/trials.hpp"

namespace ergotic::test {

// A wall for slice 0: 15 N at 15 mm. Two more points move freely, for an end-effector.
constexpr double kWallNPerM = 1000.0;
inline const char kWall[] = R"(ergotic: 1
name: wall
sections:
  hand: {rate: gestural}
mats:
  key: {type: slice, section: hand}
  tip_x: {type: slice, section: hand}
  tip_y: {type: slice, section: hand}
  ground: {type: ground, section: hand, at: [0, 0]}
lias:
  wall: {type: spring_damper, between: [key, ground], stiffness: 1000, damping: 2}
ports:
  key: {mat: key, slice: 0}
  tip_x: {mat: tip_x}
  tip_y: {mat: tip_y}
)";
constexpr double kForceN = 15.0;

/// Where even the shortest stall excuses that there is not all of the force: a station mutes it
/// when it has missed ticks, and lets it back in 50 ms.
inline Trials::Window mutedBefore(std::int64_t time_ns) {
  return {time_ns - 60'000'000, time_ns, ReferenceThreads::kMinNs};
}

}  // namespace ergotic::test
