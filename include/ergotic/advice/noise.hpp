// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Noise that a position sensor adds to a position, tick by tick.
struct SensorNoise {
  double rms = 0.5e-6;    ///< m, before rounding
  double quantum = 1e-6;  ///< m, step of rounding

  /// Total of both, white, m rms: rounding adds quantum/sqrt(12).
  double total() const;
};

/// Force that the noise causes at the hand, at the device, with everything but the slice held.
struct NoiseFloor {
  int port = 0;             ///< index in Scene::ports
  double position = 0.0;    ///< m rms: SensorNoise::total
  double force = 0.0;       ///< N rms, as the scene is; infinite if a filter is not stable
  double unfiltered = 0.0;  ///< N rms, if its links were on the slice itself
  double behind = 0.0;      ///< m rms, at the links: behind the filter, if there is one
};

/// Ports of agents have none.
/// \param scene  settled
/// Realtime: no. Source: docs/physics/stability.md, "Noise of the sensors".
std::vector<NoiseFloor> noiseFloors(const scene::Scene& scene,
                                    const Rates& rates,
                                    const SensorNoise& noise = {});

}  // namespace ergotic::physics
