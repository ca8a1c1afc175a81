// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ergotic/physics/instrument.hpp"
#include "ergotic/rt/mailbox.hpp"

namespace ergotic::station {

/// What displays get of a model: one frame of its motion.
struct MotionFrame {
  std::int64_t tick = 0;
  std::vector<float> displacement;  ///< [mats] m from rest
};

/// An instrument ready to play: everything the tick needs for it is allocated here.
/// Made and destroyed outside the real-time thread.
struct Performer {
  explicit Performer(std::unique_ptr<physics::Instrument> made);

  std::unique_ptr<physics::Instrument> instrument;
  std::vector<int> slice_of_port;
  std::vector<double> positions;  ///< [ports] m, in the model
  std::vector<double> forces;     ///< [ports] N, in the model
  std::vector<double> inputs;     ///< [R][input channels]
  std::vector<double> outputs;    ///< [R][output channels]
  rt::Mailbox<MotionFrame> motion;
};

}  // namespace ergotic::station
