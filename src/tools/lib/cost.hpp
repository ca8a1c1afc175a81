// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/engine/instrument.hpp"

namespace ergotic::tools {

/// Cost of an instrument on this machine, now.
struct Cost {
  double tick_ns = 0.0;           ///< thread CPU time of one tick, the best of several runs
  double frame_ns = 0.0;          ///< the same per audio frame
  double real_time_factor = 0.0;  ///< real time over computing time
};

/// Runs the instrument, untouched, for about a tenth of a second; its state is put back after.
Cost measureCost(physics::Instrument& instrument);

}  // namespace ergotic::tools
