// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "physics/certificate/attached.hpp"
#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// Scenes of the body that slices in hands join: with the present values of the parameters, and
/// with others; with led points at positions of their ranges; with all dampers, and without those
/// that may have no effect. Links elsewhere in the scene are removed. \see parameterCases()
std::vector<scene::Scene> casesOf(const Attached& body, const RatedNetwork& networks);

}  // namespace ergotic::physics
