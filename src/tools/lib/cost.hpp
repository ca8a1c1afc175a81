// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/engine/instrument.hpp"

namespace ergotic::tools {

/// What an instrument costs on this machine, now.
struct Cost {
  double tick_ns = 0.0;           ///< of one tick, the best of several runs, thread CPU time
  double frame_ns = 0.0;          ///< the same per audio frame
  double real_time_factor = 0.0;  ///< how many times faster than it sounds
};

/// Runs the instrument, untouched, for about a tenth of a second; its state is put back after.
Cost measureCost(physics::Instrument& instrument);

}  // namespace ergotic::tools
