// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "ergotic/physics/options.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "lab/lib/bench_probe.hpp"

namespace ergotic::tools {

/// The least that any program must do for one audio frame of a scene.
///
/// Bytes: position and velocity of every coordinate, read and written; a mass, stiffness or damping
/// of each element where there are more than 64 different ones; one number to find the other end of
/// each link where links reach in more than 16 different ways. Operations: additions,
/// multiplications, divisions, roots and comparisons of masses and links. What is stepped at slower
/// rates counts by its share.
struct BenchWork {
  std::size_t resident = 0;  ///< bytes that hold the scene
  double bytes = 0.0;        ///< read and written per frame
  double operations = 0.0;   ///< per frame

  /// Time of one frame, ns, if the bytes come from where they fit and nothing else is in the way.
  double limitNs(const MachineLimits& limits) const;
};

BenchWork workOf(const scene::Scene& scene,
                 const physics::Rates& rates,
                 physics::Precision precision);

}  // namespace ergotic::tools
