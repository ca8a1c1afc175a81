// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "physics/settling/automatic_rate.hpp"

namespace ergotic::physics {

/// Nothing is proven of a slower mass beside a link that is not linear: hold and mean make no
/// energy on the average only. Where such a link leaves its scheme open, what forces move in the
/// slower section is stepped at the faster rate, up to some hundred modules, and a note says so: a
/// hammer, a bridge, a key. Slices stay; so do sections behind a chaplet, which is there for that.
/// \param scene     whose rates are chosen
/// \param complete  settles everything else of a candidate
/// Realtime: no. Source: docs/physics.md, "Model no more than a scene needs".
void raiseRates(scene::Scene& scene,
                const Rates& rates,
                const Complete& complete,
                std::vector<std::string>& notes);

}  // namespace ergotic::physics
