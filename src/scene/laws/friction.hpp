// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/scene/scene.hpp"
#include "scene/limits.hpp"

/// Friction that sticks: what readers and rules share.
namespace ergotic::scene {

/// Limits of coefficients of friction: products with forces stay within single precision.
constexpr Limits kFrictionLimits{"", 0.0, 100.0};
constexpr Limits kFallShareLimits{"", 0.0, 100.0, true};
constexpr Limits kFallWidthLimits{"m/s", 0.0, kInfinity, true};

/// Fault of a table of mu over |v|; empty: none. With slopes that never fall, mu meets the straight
/// line of a step twice at most, so that the largest slip is found from above.
std::string coefficientFault(const Table& table);

}  // namespace ergotic::scene
