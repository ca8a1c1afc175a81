// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// [lias] Index of the link that presses each link, -1: none; empty if no link is pressed.
/// Realtime: no. Cost: O(links)
std::vector<int> pressersOf(const Scene& scene);

}  // namespace ergotic::scene
