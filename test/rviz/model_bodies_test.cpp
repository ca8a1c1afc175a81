// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_bodies.hpp"

#include <gtest/gtest.h>

#include "rviz/grab_geometry.hpp"
#include "rviz/model_structures.hpp"

namespace ergotic::panel {
namespace {

/// A key that throws a hammer at a string of 30 modules along y.
struct KeyAndString : StructureMaker {
  std::uint32_t key = 0;
  KeyAndString() {
    structure.law_names = {"contact"};
    string(30, 0.0F);
    key = module(ModelStructure::SLICE, -0.01F, 0.0F, 0.0F);
    const std::uint32_t hammer = module(ModelStructure::MASS, -0.01F, 0.0F, 0.0F);
    link(key, hammer);
    link(hammer, 10);
  }
};

/// The block of a key reaches from what it touches to the player, who sits at the lower end of z.
TEST(ModelBodiesTest, TheAxisOfAKeyGoesThroughItsBlock) {
  const KeyAndString scene;
  const std::vector<DrawnBody> bodies = bodiesOf(scene.structure, shapeOf(scene.structure), 1.0F);
  ASSERT_EQ(bodies.size(), 2U);
  EXPECT_EQ(bodies[0].module, scene.key);
  const auto ends = axisOf(bodies[0]);
  const Eigen::Vector3f axis = ends[1] - ends[0];
  const Eigen::Vector3f across = bodies[0].turn.col(2);
  EXPECT_NEAR(std::abs(axis.normalized().dot(across)), 1.0F, 1e-5F);
  Eigen::AlignedBox3f drawn;
  for (const Eigen::Vector3f& corner : bodies[0].solid->corners) {
    drawn.extend(bodies[0].radius * (bodies[0].turn * corner));
  }
  EXPECT_NEAR(axis.norm(), drawn.sizes().maxCoeff(), 1e-6F);
  EXPECT_TRUE(drawn.contains(0.99F * ends[0] + 0.01F * ends[1]));
  EXPECT_TRUE(drawn.contains(0.01F * ends[0] + 0.99F * ends[1]));
}

TEST(ModelBodiesTest, AHandleIsAsLongAsItsBody) {
  const KeyAndString scene;
  Handles message;
  message.display_zoom = 1.0;
  message.names = {"key"};
  message.modules = {scene.key};
  message.end_effectors = {""};
  message.indices = {0, -1, -1};
  message.scales = {1, 1, 1};
  message.offsets = {0, 0, 0};
  HandleSet set;
  set.show(scene.structure);
  set.show(message);
  ASSERT_EQ(set.handles().size(), 1U);
  const auto& axis = set.handles()[0].axis;
  EXPECT_GT((axis[1] - axis[0]).norm(), 0.01) << "of a string of 0.29 m";
}

TEST(GrabGeometryTest, DistanceToALineEndsAtItsEnds) {
  const Eigen::Vector2d begin(1.0, 0.0);
  const Eigen::Vector2d end(3.0, 0.0);
  EXPECT_DOUBLE_EQ(distanceToLine({2.0, 2.0}, begin, end), 2.0);
  EXPECT_DOUBLE_EQ(distanceToLine({0.0, 0.0}, begin, end), 1.0);
  EXPECT_DOUBLE_EQ(distanceToLine({6.0, 4.0}, begin, end), 5.0);
  EXPECT_DOUBLE_EQ(distanceToLine({1.0, 7.0}, begin, begin), 7.0);
}

}  // namespace
}  // namespace ergotic::panel
