// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "ergotic/scene/scene.hpp"
#include "scene/rules/fault.hpp"

namespace ergotic::scene {

/// Every point has one connection, or is one tap; what a tap lies on.
/// \pre the connections are legal
std::optional<Fault> misplacedPoint(const Scene& scene);

/// Why a tap may not lie on a module, to be said after what it is; empty: it may.
std::string reasonAgainstTap(const Scene& scene, int section, int mat);

}  // namespace ergotic::scene
