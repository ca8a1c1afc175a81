// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/markers.hpp"

#include <map>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

using visualization_msgs::Marker;

/// A row of masses, each linked to the next, in a section turned so that its x is z of the model.
scene::Scene rowOf(int masses) {
  scene::Scene scene;
  scene.sections.resize(1);
  scene.sections[0].name = "row";
  scene.sections[0].pose =
      Eigen::Translation3d(0.0, 0.0, 1.0) * Eigen::AngleAxisd(-M_PI_2, Eigen::Vector3d::UnitY());
  for (int i = 0; i < masses; ++i) {
    scene::Mat mat;
    mat.rest.y() = i;
    mat.rest.x() = 0.1;
    scene.mats.push_back(mat);
    if (i > 0) {
      scene::Lia lia;
      lia.a = i - 1;
      lia.b = i;
      scene.lias.push_back(lia);
    }
  }
  return scene;
}

TEST(MarkersTest, DrawMotionAlongTheAxisOfTheSection) {
  Markers markers(rowOf(2), 5.0);
  const auto& array = markers.draw({0.01F, 0.0F}, ::ros::Time(1.0));
  ASSERT_EQ(array.markers.size(), 2U);
  const Marker& points = array.markers[0];
  EXPECT_EQ(points.type, Marker::POINTS);
  EXPECT_EQ(points.header.frame_id, "model");
  ASSERT_EQ(points.points.size(), 2U);
  EXPECT_NEAR(points.points[0].z, 1.0 + 5.0 * 0.11, 1e-8);
  EXPECT_NEAR(points.points[1].z, 1.0 + 5.0 * 0.10, 1e-8);
  EXPECT_NEAR(points.points[1].y, 1.0, 1e-12);
  const Marker& lines = array.markers[1];
  EXPECT_EQ(lines.type, Marker::LINE_LIST);
  ASSERT_EQ(lines.points.size(), 2U);
  EXPECT_NEAR(lines.points[0].z, points.points[0].z, 1e-12);
  EXPECT_NEAR(lines.points[1].y, points.points[1].y, 1e-12);
}

TEST(MarkersTest, StandInTheFrameThatTheyAreTold) {
  Markers markers(rowOf(2), 5.0);
  markers.setFrame("left/model");
  for (const Marker& marker : markers.draw({0.0F, 0.0F}, ::ros::Time(1.0)).markers) {
    EXPECT_EQ(marker.header.frame_id, "left/model");
  }
  EXPECT_EQ(Markers::eraseAll("left/model").markers.front().header.frame_id, "left/model");
}

TEST(MarkersTest, DrawModulesOfAPlaneWhereTheyAre) {
  scene::Scene scene = rowOf(3);
  scene.sections[0].geometry = scene::Geometry::kPlane;
  Markers markers(scene, 5.0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto& array = markers.draw({0.01F, 0.02F, 0.03F, 0.04F, 0.05F, nan}, ::ros::Time(1.0));
  const auto& points = array.markers[0].points;
  ASSERT_EQ(points.size(), 3U);
  // x of the section is z of the model; y of both is the same; nothing is magnified.
  EXPECT_NEAR(points[0].z, 1.11, 1e-8);
  EXPECT_NEAR(points[0].y, 0.02, 1e-8);
  EXPECT_NEAR(points[1].z, 1.13, 1e-8);
  EXPECT_NEAR(points[1].y, 1.04, 1e-8);
  EXPECT_NEAR(points[2].z, 1.10, 1e-8) << "one coordinate is no number: drawn at rest";
  EXPECT_NEAR(points[2].y, 2.0, 1e-12);
  const auto& ends = array.markers[1].points;
  ASSERT_EQ(ends.size(), 4U);
  EXPECT_EQ(ends[1].y, points[1].y);
  EXPECT_EQ(ends[2].z, points[1].z);
}

TEST(MarkersTest, FollowTheDisplacementsOfMixedGeometries) {
  scene::Scene scene = rowOf(2);
  scene.sections.push_back(scene.sections[0]);
  scene.sections[0].geometry = scene::Geometry::kSpace;
  scene.mats[1].section = 1;
  Markers markers(scene, 10.0);
  const auto& array = markers.draw({0.1F, 0.2F, 0.3F, 0.4F}, ::ros::Time(1.0));
  ASSERT_EQ(array.markers.size(), 3U) << "the second section has no links of its own";
  EXPECT_NEAR(array.markers[0].points[0].x, -0.3, 1e-7) << "z of the section is -x of the model";
  EXPECT_NEAR(array.markers[0].points[0].y, 0.2, 1e-7);
  EXPECT_NEAR(array.markers[2].points[0].z, 1.0 + 10.0 * 0.5, 1e-6);
}

TEST(MarkersTest, ChunksStayBelowWhatRvizBears) {
  Markers markers(rowOf(20001), 1.0);
  const auto& array = markers.draw(std::vector<float>(20001), ::ros::Time(1.0));
  std::size_t points = 0;
  std::size_t ends = 0;
  for (const Marker& marker : array.markers) {
    EXPECT_LE(marker.points.size(), Markers::kChunkPoints);
    (marker.type == Marker::POINTS ? points : ends) += marker.points.size();
    if (marker.type == Marker::LINE_LIST) {
      EXPECT_EQ(marker.points.size() % 2, 0U);
    }
  }
  EXPECT_EQ(points, 20001U);
  EXPECT_EQ(ends, 40000U);
  EXPECT_EQ(array.markers.size(), 5U);
}

TEST(MarkersTest, MarkersOfOneNamespaceHaveNumbersOfTheirOwn) {
  Markers markers(rowOf(40000), 1.0);
  std::map<std::string, std::int32_t> next;
  for (const Marker& marker : markers.draw(std::vector<float>(40000), ::ros::Time(1.0)).markers) {
    EXPECT_EQ(marker.id, next[marker.ns]++);
  }
  EXPECT_EQ(next.size(), 2U);
}

TEST(MarkersTest, WhatIsNotFiniteIsDrawnAtRest) {
  Markers markers(rowOf(2), 5.0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const auto& points = markers.draw({nan, infinity}, ::ros::Time(1.0)).markers[0].points;
  EXPECT_NEAR(points[0].z, 1.5, 1e-12);
  EXPECT_NEAR(points[1].z, 1.5, 1e-12);
}

}  // namespace
}  // namespace ergotic::node
