// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "physics/certificate/attached.hpp"
#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// What slices in hands join, with the present values of the parameters, and others; at places of
/// points that are led; with all dampers, and without those that may do nothing. What else is in
/// the scene has lost its links. \see parameterCases()
std::vector<scene::Scene> casesOf(const Attached& body, const RatedNetwork& networks);

}  // namespace ergotic::physics
