// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// What a number can be: parameters move within a range.
struct Range {
  double lowest = 0.0;
  double highest = 0.0;
};

/// Both ends of what a value can be. What follows an audio input has no range and counts as 0.
Range rangeOf(const scene::Scene& scene, const scene::Value& v);
/// The largest absolute value.
double largest(const scene::Scene& scene, const scene::Value& v);

}  // namespace ergotic::physics
