// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// One interval of a curve: y = c0 + c1 u + c2 u^2 + c3 u^3 with u = x - begin, up to the next
/// piece's begin.
struct CurvePiece {
  double begin = 0.0;
  double c0 = 0.0;
  double c1 = 0.0;
  double c2 = 0.0;
  double c3 = 0.0;
};

/// A table between its first and its last point, in pieces sorted by `begin`.
struct Curve {
  std::vector<CurvePiece> pieces;  ///< pieces, one fewer than the table has points
  double end = 0.0;                ///< x of the last point
  double end_value = 0.0;          ///< y of the last point
  double smallest_slope = 0.0;     ///< smallest dy/dx between the first and the last point
  double largest_slope = 0.0;
};

/// Straight lines, or, if the table is smooth, the monotone cubic: it goes through every point, has
/// a continuous slope, and rises or falls between two points where they do, without overshoot;
/// three points on a straight line give a straight line.
///
/// The slope at an inner point is the weighted harmonic mean of the slopes of the two intervals, 0
/// where these differ in sign; at the ends a three-point estimate, limited to keep the shape.
/// \pre    at least two points, finite, their x increasing
/// \return finite numbers, unless two points are so close to each other that a slope overflows;
///         `validate` refuses such tables
/// Realtime: no. Cost: O(points).
/// Source: Fritsch and Carlson 1980, SIAM J. Numer. Anal. 17(2); Fritsch and Butland 1984, SIAM J.
/// Sci. Stat. Comput. 5(2).
Curve interpolate(const Table& table);

/// Value at x; before the first and after the last point, the value at that point.
/// Realtime: yes. Cost: O(log pieces).
double valueAt(const Curve& curve, double x) noexcept;

/// True if every number of the curve is finite.
bool isFinite(const Curve& curve);

}  // namespace ergotic::scene
