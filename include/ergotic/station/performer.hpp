// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/physics/certify.hpp"
#include "ergotic/physics/instrument.hpp"
#include "ergotic/rt/mailbox.hpp"
#include "ergotic/tgr/driver.hpp"

namespace ergotic::station {

/// What displays get of a model: one frame of its motion, and how it fares.
struct MotionFrame {
  std::int64_t tick = 0;
  std::vector<float> displacement;  ///< [Scene::coordinates] m from rest
  physics::Energies energies;
  std::vector<physics::GuardReport> guards;
};

/// An instrument ready to play: everything the tick needs for it is allocated here.
/// Made and destroyed outside the real-time thread.
struct Performer {
  /// \pre `made` is not null. Realtime: no. Thread: any
  explicit Performer(std::unique_ptr<physics::Instrument> made);

  /// Puts what the instrument does now into `motion`. Realtime: yes. Thread: tick
  /// Cost: O(modules + links)
  void publishMotion(std::int64_t tick) noexcept;

  std::unique_ptr<physics::Instrument> instrument;
  physics::Certificate certificate;   ///< filled by makePerformer
  std::vector<std::string> warnings;  ///< of scene and certificate, and notes of `settle`
  std::vector<int> slice_of_port;
  std::vector<double> parameters;  ///< [parameters] values now in force; written by the tick
  std::vector<double> positions;   ///< [ports] m, in the model
  std::vector<double> forces;      ///< [ports] N, in the model
  std::vector<double> inputs;      ///< [R][input channels]
  std::vector<double> outputs;     ///< [R][output channels]
  rt::Mailbox<MotionFrame> motion;
};

/// What makePerformer accepts.
struct PerformerPolicy {
  bool allow_unproven = false;   ///< play what has no bound
  bool allow_unstable = false;   ///< play even what is known to blow up
  int slices = tgr::kMaxSlices;  ///< of the device that it will be played with
};

/// Validates, settles, certifies, compiles and warms a scene: the instrument's is the settled one.
/// Realtime: no. Thread: any
/// \throws TextError or Exception if the scene is not valid, needs a slice that the device does not
///         have, or its verdict is refused (the text holds the findings of the certificate)
std::unique_ptr<Performer> makePerformer(scene::Scene scene,
                                         const physics::Rates& rates,
                                         const physics::CompileOptions& options,
                                         const PerformerPolicy& policy = {});

}  // namespace ergotic::station
