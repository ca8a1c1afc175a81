// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/layout/layout.hpp"

namespace ergotic::physics {

/// Slots of the points that are taps. \pre modules are placed
void placeTaps(const scene::Scene& scene, Layout& layout);
/// Slots of the points that lie on grids. \pre modules are placed
void placeConnections(const scene::Scene& scene, const Rates& rates, Layout& layout);

/// Runs of links, and the points through which they see other geometries and rates.
/// \pre modules, taps and connections are placed
/// \throws Exception if links join sections whose divisors do not divide one another
void placeLinks(const scene::Scene& scene, const Rates& rates, Layout& layout);

}  // namespace ergotic::physics
