// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/slopes.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/scene/table.hpp"

namespace ergotic::scene {

Slopes slopesUpTo(double stiffness, double damping) {
  return {{0.0, stiffness}, {0.0, damping}};
}

double steepest(const Table& table) {
  if (table.empty()) {
    return 0.0;
  }
  const Curve curve = interpolate(table);
  return std::max(std::abs(curve.smallest_slope), std::abs(curve.largest_slope));
}

bool rises(const Table& table) {
  return table.empty() || interpolate(table).smallest_slope >= 0.0;
}

bool brakes(const Table& table) {
  if (rises(table)) {
    return true;
  }
  const double at_rest = valueAt(interpolate(table), 0.0);
  return std::all_of(table.points.begin(), table.points.end(), [at_rest](const auto& point) {
    return (point.second - at_rest) * point.first >= 0.0;
  });
}

double drive(const Table& table) {
  return brakes(table) ? 0.0 : -interpolate(table).smallest_slope;
}

bool isOdd(const Table& table) {
  const auto& points = table.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& mirrored = points[points.size() - 1 - i];
    if (points[i].first != -mirrored.first || points[i].second != -mirrored.second) {
      return false;
    }
  }
  return true;
}

FrictionSlopes frictionSlopesOf(const Table& table) {
  if (table.empty()) {
    return {};
  }
  const Curve curve = interpolate(table);
  return {std::max(curve.largest_slope, 0.0), std::max(-curve.smallest_slope, 0.0)};
}

}  // namespace ergotic::scene
