// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/rt/mailbox.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/rig.hpp"

namespace ergotic::station {

/// Data of a model for displays: one frame of its motion, its energies, and its energy-stable
/// links.
struct MotionFrame {
  std::int64_t tick = 0;
  std::vector<float> displacement;  ///< [Scene::coordinates] m from rest
  physics::Energies energies;
  std::vector<physics::TankReport> tanks;
};

/// An instrument ready to play: everything the tick needs for it is allocated here.
/// Made and destroyed outside the real-time thread.
struct Performer {
  /// \pre neither is null, and `between` was made for the scene of `made`. Realtime: no. Thread:
  /// any
  Performer(std::unique_ptr<physics::Instrument> made, std::unique_ptr<tgr::Rig> between);

  /// Puts what the instrument does now into `motion`. Realtime: yes. Thread: tick
  /// Cost: O(modules + links)
  void publishMotion(std::int64_t tick) noexcept;

  /// Restores the initial state; parameters keep their values. Realtime: yes. Thread: tick
  void restart() noexcept;

  std::unique_ptr<physics::Instrument> instrument;
  std::unique_ptr<tgr::Rig> rig;      ///< between device and ports
  std::int64_t ticks = 0;             ///< number of ticks played; the time of its agents
  physics::Certificate certificate;   ///< filled by makePerformer
  std::vector<std::string> warnings;  ///< warnings of scene and certificate, and notes of `settle`
  bool allow_unproven = false;        ///< loaded although it is unproven
  std::vector<double> parameters;     ///< [parameters] values now in force; written by the tick
  std::vector<double> positions;      ///< [ports] m, in the model
  std::vector<double> forces;         ///< [ports] N, in the model
  std::vector<double> inputs;         ///< [R][input channels]
  std::vector<double> outputs;        ///< [R][output channels]
  rt::Mailbox<MotionFrame> motion;
  std::vector<unsigned char> initial;  ///< state of the instrument as it was made
};

/// Requirements that makePerformer checks.
struct PerformerPolicy {
  bool allow_unproven = false;   ///< accept models without a proven bound
  bool allow_unstable = false;   ///< accept even models that are known to blow up
  double max_load = 0.0;         ///< largest permitted measureLoad; 0: load is not measured
  int slices = tgr::kMaxSlices;  ///< number of slices of the device
  physics::DeviceTraits device;  ///< device traits that determine passivity
  tgr::EndEffectors end_effectors;
  /// Callback for the present stage, as in `certify 198003 modules and links`, for progress
  /// displays.
  std::function<void(const std::string& stage)> on_stage;
};

/// A scene is refused for its verdict; the text holds the findings of the certificate.
class RefusedScene : public Exception {
 public:
  RefusedScene(const std::string& what, physics::Verdict verdict)
      : Exception(what), verdict_(verdict) {}
  physics::Verdict verdict() const noexcept { return verdict_; }

 private:
  physics::Verdict verdict_;
};

/// Validates, settles, certifies, compiles and warms a scene: the instrument's is the settled one.
/// Realtime: no. Thread: any
/// \throws TextError or Exception if the scene is not valid, needs a slice that the device does not
///         have, or is too heavy; RefusedScene
std::unique_ptr<Performer> makePerformer(scene::Scene scene,
                                         const physics::Rates& rates,
                                         const physics::CompileOptions& options,
                                         const PerformerPolicy& policy = {});

}  // namespace ergotic::station
