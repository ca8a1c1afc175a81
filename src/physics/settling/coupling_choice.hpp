// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "physics/settling/automatic_rate.hpp"

namespace ergotic::physics {

/// Chooses how faster sections see every slice that leaves it to the station: of hold, smooth and
/// chaplets that a hand bears in silence, as the certificate judges its ports, what is predicted to
/// err least; where it bears none, what is nearest to it. A slice that no faster section sees is
/// held.
/// Source: docs/physics.md, "Hands that glide".
void chooseCouplings(scene::Scene& scene,
                     const Rates& rates,
                     const Complete& complete,
                     std::vector<std::string>& notes);

/// Asks for a chaplet at every link of the slices that want them, to be put there by
/// insertFilters().
void askForChaplets(scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
