// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// Of every link that another one presses the index of that, else -1; empty if none is pressed.
/// Realtime: no. Cost: O(links)
std::vector<int> pressersOf(const Scene& scene);

}  // namespace ergotic::scene
