// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/framing.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace ergotic::panel {
namespace {

/// How far from the middle of the picture a point is, of half its width and of half its height.
Eigen::Vector2d placeOf(const Eigen::Vector3d& point, const Look& look, const Framing& framing) {
  const Eigen::Vector3d out(std::cos(look.yaw) * std::cos(look.pitch),
                            std::sin(look.yaw) * std::cos(look.pitch), std::sin(look.pitch));
  const Eigen::Vector3d right(-std::sin(look.yaw), std::cos(look.yaw), 0.0);
  const Eigen::Vector3d at = point - framing.focus;
  const double depth = framing.distance - at.dot(out);
  EXPECT_GT(depth, 0.0) << "behind the camera";
  const double half = depth * std::tan(0.5 * look.field_of_view);
  return {at.dot(right) / (half * look.aspect), at.dot(out.cross(right)) / half};
}

TEST(FramingTest, FillsThePictureWithAMarginWhereverTheCameraIs) {
  const std::vector<Eigen::Vector3d> points = {
      {0.0, 0.0, 0.0}, {0.0, 0.65, 0.0}, {0.1, 0.2, 0.05}, {0.02, 0.6, -0.04}};
  for (const double yaw : {0.0, 1.0, 3.4, -2.0}) {
    for (const double pitch : {-0.3, 0.42, 1.2}) {
      for (const double aspect : {0.7, 1.25, 2.0}) {
        const Look look{yaw, pitch, 0.7854, aspect};
        const Framing framing = frame(points, look);
        double outermost = 0.0;
        for (const Eigen::Vector3d& point : points) {
          outermost = std::max(outermost, placeOf(point, look, framing).cwiseAbs().maxCoeff());
        }
        EXPECT_NEAR(outermost, 1.0 / 1.15, 1e-9) << yaw << ", " << pitch << ", " << aspect;
      }
    }
  }
}

TEST(FramingTest, LooksFromWhereASceneSays) {
  const Shot shot{{1.0, -2.0, 3.0}, {0.1, 0.2, -0.3}};
  const Look look = lookOf(shot, {0.0, 0.0, 0.5, 1.5});
  const Eigen::Vector3d out(std::cos(look.yaw) * std::cos(look.pitch),
                            std::sin(look.yaw) * std::cos(look.pitch), std::sin(look.pitch));
  EXPECT_TRUE(out.isApprox((shot.from - shot.at).normalized()));
  EXPECT_EQ(look.field_of_view, 0.5);
  EXPECT_EQ(look.aspect, 1.5);
  const Look down = lookOf({{0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}}, {2.0, 0.0, 0.5, 1.5});
  EXPECT_EQ(down.yaw, 2.0) << "straight down there is none";
  EXPECT_GT(down.pitch, 1.5);
  EXPECT_LT(down.pitch, 0.5 * M_PI);
}

TEST(FramingTest, KeepsItsDistanceFromASinglePoint) {
  const Framing framing = frame({{0.1, 0.2, 0.3}}, {});
  EXPECT_TRUE(framing.focus.isApprox(Eigen::Vector3d(0.1, 0.2, 0.3)));
  EXPECT_EQ(framing.distance, 0.1);
}

}  // namespace
}  // namespace ergotic::panel
