// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"
#include "ergotic/tgr/end_effector.hpp"

namespace ergotic::tgr {

constexpr int kMaxPorts = 128;  ///< largest number of ports of a scene

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

  /// Maps forces to slices, by the transposed Jacobian of the last toModel.
  /// \param ports        [ports] N, in the model
  /// \param[out] slices  [slices] N
  virtual void toDevice(const double* ports, double* slices) const noexcept = 0;

  /// Slices that move something of the scene, a bit each.
  virtual std::uint64_t slicesInUse() const noexcept = 0;
};

/// Ports that no slice moves by itself under these end-effectors, though the scene says so: an
/// end-effector has the port, or its slice. Indices in Scene::ports.
std::vector<int> takenPorts(const scene::Scene& scene, const EndEffectors& end_effectors);

/// Stiffness or damping of a model as rendered at one slice, in the device's scale.
struct Rendered {
  int slice = 0;
  double alone = 0.0;  ///< when this slice moves and the others rest
  /// Largest eigenvalue over all slices of its end-effector: the value for their worst joint
  /// motion. Slices of equal traits are passive if one of them would be with this.
  double together = 0.0;
};

/// Computes the values of each slice in use, by the Jacobians at rest: sum J^T K_port J force_scale
/// / position_scale.
/// \param of_ports  [ports] N/m or N s/m, as of physics::PortCertificate (at the device, with the
///                  port's own scales)
std::vector<Rendered> renderedAtSlices(const scene::Scene& scene,
                                       const EndEffectors& end_effectors,
                                       const std::vector<double>& of_ports);

/// \param slices  of the device
/// \throws TextError with the place of the end-effector if a slice or a port does not exist or is
///         taken twice, or the scene has more than kMaxPorts ports
std::unique_ptr<Rig> makeRig(const scene::Scene& scene,
                             const EndEffectors& end_effectors,
                             int slices);

}  // namespace ergotic::tgr
