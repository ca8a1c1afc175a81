// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace ergotic::scene {
namespace {

/// An interval between two points.
struct Interval {
  double width = 0.0;
  double slope = 0.0;
};

std::vector<Interval> intervalsOf(const Table& table) {
  std::vector<Interval> intervals;
  for (std::size_t i = 1; i < table.points.size(); ++i) {
    const auto& [x0, y0] = table.points[i - 1];
    const auto& [x1, y1] = table.points[i];
    intervals.push_back({x1 - x0, (y1 - y0) / (x1 - x0)});
  }
  return intervals;
}

bool differInSign(double a, double b) {
  return (a > 0.0) != (b > 0.0) || a == 0.0 || b == 0.0;
}

double innerSlope(const Interval& before, const Interval& after) {
  if (differInSign(before.slope, after.slope)) {
    return 0.0;
  }
  if (before.slope == after.slope) {
    return after.slope;  // without rounding: straight lines stay straight
  }
  const double w0 = 2.0 * after.width + before.width;
  const double w1 = after.width + 2.0 * before.width;
  return (w0 + w1) / (w0 / before.slope + w1 / after.slope);
}

/// Slope at an end: that of the parabola through three points, as far as it keeps the shape.
double endSlope(const Interval& last, const Interval& inner) {
  const double slope =
      last.slope + (last.slope - inner.slope) * last.width / (last.width + inner.width);
  if (differInSign(slope, last.slope)) {
    return 0.0;
  }
  const bool turns = differInSign(last.slope, inner.slope);
  return turns && std::abs(slope) > 3.0 * std::abs(last.slope) ? 3.0 * last.slope : slope;
}

/// Slope at every point.
std::vector<double> slopesOf(const std::vector<Interval>& intervals) {
  const std::size_t count = intervals.size();
  if (count == 1) {
    return {intervals[0].slope, intervals[0].slope};
  }
  std::vector<double> slopes = {endSlope(intervals[0], intervals[1])};
  for (std::size_t i = 1; i < count; ++i) {
    slopes.push_back(innerSlope(intervals[i - 1], intervals[i]));
  }
  slopes.push_back(endSlope(intervals[count - 1], intervals[count - 2]));
  return slopes;
}

/// The cubic over an interval with the given slopes at its ends.
CurvePiece cubicPiece(std::pair<double, double> from, const Interval& i, double s0, double s1) {
  return {from.first, from.second, s0, (3.0 * i.slope - 2.0 * s0 - s1) / i.width,
          (s0 + s1 - 2.0 * i.slope) / (i.width * i.width)};
}

void widen(Curve& curve, double slope) {
  curve.smallest_slope = std::min(curve.smallest_slope, slope);
  curve.largest_slope = std::max(curve.largest_slope, slope);
}

/// Takes the slopes of a piece into account: at its ends, and where it is steepest or flattest.
void widenByPiece(Curve& curve, const CurvePiece& piece, const Interval& i, double s1) {
  widen(curve, piece.c1);
  widen(curve, s1);
  const double u = -piece.c2 / (3.0 * piece.c3);
  if (u > 0.0 && u < i.width) {
    const double slope = piece.c1 + piece.c2 * u;
    // The piece is monotone; rounding must not say otherwise.
    widen(curve, differInSign(slope, i.slope) ? 0.0 : slope);
  }
}

}  // namespace

Curve interpolate(const Table& table) {
  const std::vector<Interval> intervals = intervalsOf(table);
  Curve curve;
  std::tie(curve.end, curve.end_value) = table.points.back();
  curve.smallest_slope = curve.largest_slope = intervals.front().slope;
  if (!table.smooth) {
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      const auto& [x, y] = table.points[i];
      curve.pieces.push_back({x, y, intervals[i].slope, 0.0, 0.0});
      widen(curve, intervals[i].slope);
    }
    return curve;
  }
  const std::vector<double> slopes = slopesOf(intervals);
  curve.smallest_slope = curve.largest_slope = slopes.front();
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    curve.pieces.push_back(cubicPiece(table.points[i], intervals[i], slopes[i], slopes[i + 1]));
    widenByPiece(curve, curve.pieces.back(), intervals[i], slopes[i + 1]);
  }
  return curve;
}

double valueAt(const Curve& curve, double x) noexcept {
  if (x >= curve.end) {
    return curve.end_value;
  }
  const auto after = std::upper_bound(curve.pieces.begin(), curve.pieces.end(), x,
                                      [](double at, const CurvePiece& p) { return at < p.begin; });
  if (after == curve.pieces.begin()) {
    return curve.pieces.front().c0;
  }
  const CurvePiece& p = *(after - 1);
  const double u = x - p.begin;
  return p.c0 + u * (p.c1 + u * (p.c2 + u * p.c3));
}

bool isFinite(const Curve& curve) {
  return std::all_of(curve.pieces.begin(), curve.pieces.end(), [](const CurvePiece& p) {
    return std::isfinite(p.c1) && std::isfinite(p.c2) && std::isfinite(p.c3);
  });
}

}  // namespace ergotic::scene
