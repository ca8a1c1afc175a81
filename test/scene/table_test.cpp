// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/table.hpp"

#include <random>

#include "support/test.hpp"

namespace ergotic::scene {
namespace {

double slopeAt(const CurvePiece& p, double x) {
  const double u = x - p.begin;
  return p.c1 + u * (2.0 * p.c2 + u * 3.0 * p.c3);
}

double endOf(const Curve& curve, std::size_t piece) {
  return piece + 1 < curve.pieces.size() ? curve.pieces[piece + 1].begin : curve.end;
}

TEST(TableTest, LinesGoStraightFromPointToPoint) {
  const Curve c = interpolate({{{-1.0, 2.0}, {0.0, 0.0}, {4.0, 1.0}}, false});
  ASSERT_EQ(c.pieces.size(), 2U);
  EXPECT_EQ(c.pieces[0].c1, -2.0);
  EXPECT_EQ(c.pieces[1].c1, 0.25);
  EXPECT_EQ(c.smallest_slope, -2.0);
  EXPECT_EQ(c.largest_slope, 0.25);
  EXPECT_EQ(valueAt(c, -0.25), 0.5);
  EXPECT_EQ(valueAt(c, 3.0), 0.75);
}

TEST(TableTest, ValuesAreHeldBeyondTheEnds) {
  for (const bool smooth : {false, true}) {
    const Curve c = interpolate({{{-1.0, 2.0}, {0.0, 0.0}, {4.0, 1.0}}, smooth});
    EXPECT_EQ(valueAt(c, -1.0), 2.0);
    EXPECT_EQ(valueAt(c, -100.0), 2.0);
    EXPECT_EQ(valueAt(c, 4.0), 1.0);
    EXPECT_EQ(valueAt(c, 1e300), 1.0);
  }
}

// The quadratic y = x^2 at 0, 1, 2: slopes of the intervals 1 and 3. The harmonic mean of equal
// widths is 2/(1/1 + 1/3) = 1.5; the ends are 1 + (1 - 3)/2 = 0 and 3 + (3 - 1)/2 = 4.
TEST(TableTest, SmoothCurveHasTheClosedFormOfThreePoints) {
  const Curve c = interpolate({{{0.0, 0.0}, {1.0, 1.0}, {2.0, 4.0}}, true});
  ASSERT_EQ(c.pieces.size(), 2U);
  EXPECT_EQ(c.pieces[0].c1, 0.0);
  EXPECT_EQ(c.pieces[0].c2, 1.5);   // (3 - 0 - 1.5)/1
  EXPECT_EQ(c.pieces[0].c3, -0.5);  // 0 + 1.5 - 2
  EXPECT_EQ(c.pieces[1].c1, 1.5);
  EXPECT_EQ(c.pieces[1].c2, 2.0);   // 9 - 3 - 4
  EXPECT_EQ(c.pieces[1].c3, -0.5);  // 1.5 + 4 - 6
  EXPECT_EQ(valueAt(c, 0.5), 1.5 / 4.0 - 0.5 / 8.0);
  EXPECT_EQ(c.smallest_slope, 0.0);
  // y' = 1.5 + 4 u - 1.5 u^2 is largest at the end, u = 1.
  EXPECT_EQ(c.largest_slope, 4.0);
}

TEST(TableTest, WeightsOfTheSlopesFollowTheWidths) {
  // Widths 1 and 3, slopes 2 and 4: w = 2*3 + 1 = 7 and 3 + 2*1 = 5; 12/(7/2 + 5/4).
  const Curve c = interpolate({{{0.0, 0.0}, {1.0, 2.0}, {4.0, 14.0}}, true});
  EXPECT_DOUBLE_EQ(c.pieces[1].c1, 12.0 / (7.0 / 2.0 + 5.0 / 4.0));
  // End: 2 + (2 - 4) * 1/4.
  EXPECT_DOUBLE_EQ(c.pieces[0].c1, 1.5);
}

TEST(TableTest, StepIsTheSmoothestCubicAndItsSteepestPlaceIsInside) {
  const Curve c = interpolate({{{-1.0, 0.0}, {0.0, 0.0}, {2.0, 4.0}, {3.0, 4.0}}, true});
  // 3 t^2 - 2 t^3 with t = x/2, height 4: slope 1.5 * 4/2 in the middle.
  EXPECT_DOUBLE_EQ(valueAt(c, 1.0), 2.0);
  EXPECT_DOUBLE_EQ(valueAt(c, 0.5), 4.0 * (3.0 / 16.0 - 2.0 / 64.0));
  EXPECT_EQ(c.smallest_slope, 0.0);
  EXPECT_DOUBLE_EQ(c.largest_slope, 3.0);
}

TEST(TableTest, PointsOnALineGiveThatLine) {
  for (const std::size_t points : {2U, 6U}) {
    Table table;
    table.smooth = true;
    for (const double x : {-3.0, 8.0, -2.5, 0.0, 0.125, 7.0}) {
      table.points.emplace_back(x, 0.75 * x - 2.0);
    }
    table.points.resize(points);
    std::sort(table.points.begin(), table.points.end());
    const Curve c = interpolate(table);
    ASSERT_EQ(c.pieces.size(), points - 1);
    for (const CurvePiece& p : c.pieces) {
      EXPECT_EQ(p.c1, 0.75);
      EXPECT_EQ(p.c2, 0.0);
      EXPECT_EQ(p.c3, 0.0);
    }
    EXPECT_EQ(c.smallest_slope, 0.75);
    EXPECT_EQ(c.largest_slope, 0.75);
    EXPECT_EQ(valueAt(c, 3.5), 0.625);
  }
}

TEST(TableTest, SlopeOfASmoothCurveIsContinuous) {
  const Curve c =
      interpolate({{{0.0, 1.0}, {0.1, 1.5}, {1.0, 1.6}, {1.5, -2.0}, {2.0, -2.5}}, true});
  for (std::size_t i = 1; i < c.pieces.size(); ++i) {
    const double x = c.pieces[i].begin;
    EXPECT_NEAR(slopeAt(c.pieces[i - 1], x), c.pieces[i].c1, 1e-13);
    EXPECT_NEAR(c.pieces[i - 1].c0 + (x - c.pieces[i - 1].begin) *
                                         (c.pieces[i - 1].c1 +
                                          (x - c.pieces[i - 1].begin) *
                                              (c.pieces[i - 1].c2 +
                                               (x - c.pieces[i - 1].begin) * c.pieces[i - 1].c3)),
                c.pieces[i].c0, 1e-14);
  }
}

TEST(TableTest, CurveStaysBetweenItsPointsAndItsSlopesWithinTheirBounds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(1e-3, 1.0);
  std::uniform_real_distribution<double> rise(-1.0, 1.0);
  for (int table_index = 0; table_index < 200; ++table_index) {
    const bool monotone = table_index % 2 == 0;
    Table table;
    table.smooth = true;
    double x = -2.0;
    double y = 0.0;
    for (int i = 0; i < 12; ++i) {
      table.points.emplace_back(x, y);
      x += step(random);
      y += monotone ? std::max(0.0, rise(random)) : rise(random);
    }
    const Curve c = interpolate(table);
    if (monotone) {
      EXPECT_GE(c.smallest_slope, 0.0);
    }
    for (std::size_t i = 0; i < c.pieces.size(); ++i) {
      const auto [low, high] = std::minmax(table.points[i].second, table.points[i + 1].second);
      double before = table.points[i].second;
      for (int k = 1; k <= 50; ++k) {
        const double at = c.pieces[i].begin + (endOf(c, i) - c.pieces[i].begin) * k / 50.0;
        const double value = valueAt(c, at);
        EXPECT_GE(value, low - 1e-14);
        EXPECT_LE(value, high + 1e-14);
        EXPECT_GE((value - before) * (table.points[i + 1].second - table.points[i].second), -1e-14);
        EXPECT_GE(slopeAt(c.pieces[i], at), c.smallest_slope - 1e-12 * (1.0 + c.largest_slope));
        EXPECT_LE(slopeAt(c.pieces[i], at), c.largest_slope + 1e-12 * (1.0 + c.largest_slope));
        before = value;
      }
    }
  }
}

TEST(TableTest, BoundsOfTheSlopeAreReached) {
  const Curve c = interpolate({{{0.0, 0.0}, {1.0, 0.1}, {2.0, 5.0}, {3.0, 5.1}, {4.0, 2.0}}, true});
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  for (std::size_t i = 0; i < c.pieces.size(); ++i) {
    for (int k = 0; k <= 1000; ++k) {
      const double slope = slopeAt(c.pieces[i], c.pieces[i].begin + k / 1000.0);
      smallest = std::min(smallest, slope);
      largest = std::max(largest, slope);
    }
  }
  EXPECT_NEAR(c.smallest_slope, smallest, 1e-4 * std::abs(smallest));
  EXPECT_NEAR(c.largest_slope, largest, 1e-4 * largest);
}

TEST(TableTest, OverflowingSlopesAreToldByIsFinite) {
  EXPECT_TRUE(isFinite(interpolate({{{0.0, 0.0}, {1e-300, 1e-10}}, false})));
  EXPECT_FALSE(isFinite(interpolate({{{0.0, 0.0}, {1e-300, 1e10}}, false})));
  EXPECT_FALSE(isFinite(interpolate({{{0.0, 0.0}, {1e-200, 0.0}, {2e-200, 1.0}}, true})));
}

}  // namespace
}  // namespace ergotic::scene
