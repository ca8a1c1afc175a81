// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "ergotic/physics/options.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::tools {

/// A scene as one writes it down first: an array of masses, an array of links, and a scalar loop
/// over each. What `bench` and the tests of the kernels compare an instrument with: it makes the
/// same motion, and shares no code with it but the conversion to units of a step.
class PlainNetwork {
 public:
  virtual ~PlainNetwork() = default;

  /// Audio frames: masses move by the forces of their last step, then links give new ones.
  /// Realtime: yes
  virtual void step(int frames) noexcept = 0;

  /// Displacements from rest, m, in the order of physics::Instrument::readDisplacements.
  virtual void readDisplacements(double* to) const noexcept = 0;
};

/// Takes masses and grounds, constant forces and gravity, explicit springs, dampers and contacts,
/// in any one geometry, at several rates; outputs are ignored.
/// \throws Exception naming what else is in the scene
std::unique_ptr<PlainNetwork> makePlainNetwork(const scene::Scene& scene,
                                               const physics::Rates& rates,
                                               physics::Precision precision);

}  // namespace ergotic::tools
