// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// lambda = (w h)^2 of the highest mode that a section with `rate: auto` may have: 2.9 cents.
constexpr double kSlowEnough = 0.04;

/// By how much the explicit scheme raises a mode with h^2 K/M = lambda < 4, cents; 72.1 lambda to
/// first order.
double raisedCents(double lambda);

/// Makes the other choices for a scene whose rates are known.
using Complete = std::function<scene::Scene(scene::Scene)>;

/// Gives every section that leaves its rate to the station the lowest one, among the audio rate
/// over the divisors of R, at which its highest mode stays in tune (everything outside it held) and
/// the verdict on the whole scene is no worse than with the section at the audio rate. A section
/// with slices is gestural. Divisors of sections that links join divide one another.
void chooseAutomaticRates(scene::Scene& scene,
                          const Rates& rates,
                          const Complete& complete,
                          std::vector<std::string>& notes);

}  // namespace ergotic::physics
