// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "ergotic/scene/scene.hpp"
#include "scene/limits.hpp"
#include "scene/rules/fault.hpp"

namespace ergotic::scene {

constexpr Limits kTargetLimits{"m", -1e6, 1e6};  ///< of agents: differences stay finite

/// One port for a slice, one port for a coordinate of a module, one position input for a driven
/// module.
std::optional<Fault> movedTwice(const Scene& scene);

}  // namespace ergotic::scene
