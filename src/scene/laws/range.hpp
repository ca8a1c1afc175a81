// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// Range of a number: parameters move within it.
struct Range {
  double lowest = 0.0;
  double highest = 0.0;
};

/// Both ends of what a value can be. What follows an audio input has no range and counts as 0.
Range rangeOf(const Scene& scene, const Value& v);
/// The largest absolute value.
double largest(const Scene& scene, const Value& v);

}  // namespace ergotic::scene
