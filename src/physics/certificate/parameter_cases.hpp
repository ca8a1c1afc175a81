// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// A scene at its present parameters, then at both ends of all ranges, and, as far as `most` goes,
/// at all combinations of as many values of each range (at least both ends; by equal factors where
/// all are above 0) of those parameters that the modules and points `among`, and links on them,
/// follow; if `most` is above 9, also at nine values of each of these by itself.
/// \param most  at least 3
std::vector<scene::Scene> parameterCases(const scene::Scene& scene,
                                         const std::set<int>& among,
                                         int most);

}  // namespace ergotic::physics
