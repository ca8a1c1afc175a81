// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/range.hpp"

#include <algorithm>
#include <cmath>

namespace ergotic::scene {

Range rangeOf(const Scene& scene, const Value& v) {
  if (v.audio >= 0) {
    return {};
  }
  if (v.parameter < 0) {
    return {v.factor, v.factor};
  }
  const Parameter& p = scene.parameters[static_cast<std::size_t>(v.parameter)];
  const double a = v.factor * p.minimum;
  const double b = v.factor * p.maximum;
  return {std::min(a, b), std::max(a, b)};
}

double largest(const Scene& scene, const Value& v) {
  const Range range = rangeOf(scene, v);
  return std::max(std::abs(range.lowest), std::abs(range.highest));
}

}  // namespace ergotic::scene
