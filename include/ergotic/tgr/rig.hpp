// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"
#include "ergotic/tgr/end_effector.hpp"

namespace ergotic::tgr {

constexpr int kMaxPorts = 128;  ///< of a scene that is played

/// Between the slices of a device and the ports of a scene: end-effectors, scales, agents.
/// Power passes unchanged but for the scales: with all of them 1,
/// sum F_slice v_slice = sum F_port v_port. Realtime: yes. Thread: tick
class Rig {
 public:
  virtual ~Rig() = default;

  /// \param slices  [slices] m from rest
  /// \param time_s  since the model began to play, for agents
  /// \param[out] ports  [ports] m, in the model; end-effectors beyond their workspace stay where
  ///                    they were last
  /// \return slices of these, a bit each; force on them is zero
  virtual std::uint64_t toModel(const double* slices, double time_s, double* ports) noexcept = 0;

  /// By the Jacobian of the last toModel.
  /// \param ports        [ports] N, in the model
  /// \param[out] slices  [slices] N
  virtual void toDevice(const double* ports, double* slices) const noexcept = 0;

  /// Slices that move something of the scene, a bit each.
  virtual std::uint64_t slicesInUse() const noexcept = 0;
};

/// Ports that no slice moves by itself under these end-effectors, though the scene says so: an
/// end-effector has the port, or its slice. Indices in Scene::ports.
std::vector<int> takenPorts(const scene::Scene& scene, const EndEffectors& end_effectors);

/// What a slice that moves something meets of a model.
struct RenderedStiffness {
  int slice = 0;
  double stiffness = 0.0;  ///< at the device, N/m, when it moves and the others rest
  /// The same where the slices of its end-effector move together in the stiffest way: the largest
  /// eigenvalue. Slices of equal damping are passive if this stays below the limit.
  double together = 0.0;
  double limit = 0.0;  ///< passive below: 2 b / ((1 + 2 d) T)
};

/// Per slice in use, by the Jacobians at rest: K = sum J^T K_port J force_scale / position_scale.
/// \param port_stiffness  [ports] N/m, physics::PortCertificate::stiffness (at the device, with the
///                        port's own scales)
/// \param damping        of a slice, N s/m
/// \param delay_ticks    of the whole loop: 1 + Driver::extraDelayTicks()
std::vector<RenderedStiffness> renderedStiffness(const scene::Scene& scene,
                                                 const EndEffectors& end_effectors,
                                                 const std::vector<double>& port_stiffness,
                                                 double damping,
                                                 double tick_rate_hz,
                                                 double delay_ticks);

constexpr double kWarnedStiffness = 0.5;   ///< of the limit
constexpr double kRefusedStiffness = 2.0;  ///< of it

/// What to say about end-effectors whose slices meet too much, `file:line:col: warning: ...`.
struct StiffnessFindings {
  std::vector<std::string> warnings;  ///< above kWarnedStiffness times the limit
  std::vector<std::string> refusals;  ///< above kRefusedStiffness times: they will buzz or jump
};
StiffnessFindings judgeStiffness(const EndEffectors& end_effectors,
                                 const std::vector<RenderedStiffness>& rendered);

/// \param slices  of the device
/// \throws TextError with the place of the end-effector if a slice or a port does not exist or is
///         taken twice, or the scene has more than kMaxPorts ports
std::unique_ptr<Rig> makeRig(const scene::Scene& scene,
                             const EndEffectors& end_effectors,
                             int slices);

}  // namespace ergotic::tgr
