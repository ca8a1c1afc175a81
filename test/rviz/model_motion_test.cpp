// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/model_motion.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "rviz/model_structures.hpp"

namespace ergotic::panel {
namespace {

ModelState stateAt(double stamp_s, std::vector<float> displacement) {
  ModelState state;
  state.header.stamp = ros::Time(stamp_s);
  state.displacement = std::move(displacement);
  return state;
}

TEST(ModelMotionTest, StatesOfAnotherModelDoNotBelong) {
  StructureMaker maker;
  maker.row(3, 0.0F);
  maker.section(3).row(2, 0.1F);
  maker.structure.header.stamp = ros::Time(1000.0);
  const std::vector<float> all(3 + 6);
  EXPECT_TRUE(belongs(stateAt(1000.0, all), maker.structure));
  EXPECT_TRUE(belongs(stateAt(1000.5, all), maker.structure));
  EXPECT_FALSE(belongs(stateAt(1000.5, std::vector<float>(8)), maker.structure));
  EXPECT_FALSE(belongs(stateAt(999.97, all), maker.structure)) << "it was of the model before";
  EXPECT_TRUE(belongs(stateAt(500.0, all), maker.structure)) << "the clock was set back";
}

TEST(ModelMotionTest, PlacesAreAsTheStationDrawsThem) {
  StructureMaker maker;
  const std::uint32_t scalar = maker.module(ModelStructure::MASS, 0.1F, 0.2F, 0.3F);
  maker.section(3);
  const std::uint32_t free = maker.module(ModelStructure::MASS, 0.1F, 0.2F, 0.3F);
  // Turned by a quarter about z, so that its x is the y of the picture, and raised by 1 m.
  geometry_msgs::Pose& pose = maker.structure.section_poses[0];
  pose.orientation.w = pose.orientation.z = std::sqrt(0.5);
  pose.position.y = 0.15;
  ModelMotion motion(maker.structure, shapeOf(maker.structure));
  motion.setScale(5.0, 2.0);
  motion.show(stateAt(1.0, {0.01F, 0.01F, 0.02F, 0.03F}));
  // At rest it is 0.05 m along x of its section, of which the zoom makes 0.25 m.
  EXPECT_TRUE(motion.restPlaces()[scalar].isApprox(Eigen::Vector3f(0.1F, 0.4F, 0.3F), 1e-5F));
  EXPECT_TRUE(motion.places()[scalar].isApprox(Eigen::Vector3f(0.1F, 0.5F, 0.3F), 1e-5F));
  EXPECT_TRUE(motion.upOf(scalar).isApprox(Eigen::Vector3f::UnitY(), 1e-5F));
  EXPECT_TRUE(motion.places()[free].isApprox(Eigen::Vector3f(0.12F, 0.24F, 0.36F), 1e-5F));
  motion.show(stateAt(1.1, {std::nanf(""), INFINITY, 0.0F, 0.0F}));
  EXPECT_EQ(motion.places()[scalar], motion.restPlaces()[scalar]);
  EXPECT_EQ(motion.places()[free], motion.restPlaces()[free]);
}

TEST(ModelMotionTest, WhatMovesGlowsAndFadesAndHandsDoNot) {
  StructureMaker maker;
  maker.string(5, 0.0F);
  const std::uint32_t hammer = maker.module(ModelStructure::MASS, 0.0F, 0.0F, 0.1F);
  const std::uint32_t hand = maker.module(ModelStructure::SLICE, 0.0F, 0.0F, 0.2F);
  ModelMotion motion(maker.structure, shapeOf(maker.structure));
  motion.show(stateAt(1.00, {0.0F, 1e-3F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}));
  EXPECT_EQ(motion.glow()[1], 0.0F) << "it has not been seen to move";
  motion.show(stateAt(1.03, {0.0F, 0.0F, 1e-3F, 1e-4F, 0.0F, 1.0F, 1.0F}));
  EXPECT_FLOAT_EQ(motion.glow()[1], 1.0F);
  EXPECT_FLOAT_EQ(motion.glow()[2], 1.0F);
  EXPECT_NEAR(motion.glow()[3], std::pow(0.1, 0.75), 1e-3);
  EXPECT_EQ(motion.glow()[0], 0.0F);
  EXPECT_FLOAT_EQ(motion.glow()[hammer], 1.0F) << "it is compared with single masses alone";
  EXPECT_EQ(motion.glow()[hand], 0.0F);
  for (int i = 1; i <= 90; ++i) {
    motion.show(stateAt(1.03 + i / 30.0, {0.0F, 0.0F, 1e-3F, 1e-4F, 0.0F, 1.0F, 1.0F}));
  }
  EXPECT_LT(motion.glow()[2], 0.01F);
}

TEST(ModelMotionTest, WhatIsTautIsWarmAndWhatIsSlackIsCold) {
  StructureMaker maker;
  maker.structure.section_dimensions[0] = 3;
  maker.row(6, 0.0F);  // 1 cm apart along y
  ModelMotion motion(maker.structure, shapeOf(maker.structure));
  motion.glowBy(GlowBy::kTension);
  std::vector<float> moved(18, 0.0F);
  moved[3 * 5 + 1] = 2e-3F;  // the end is drawn out
  moved[3 * 0 + 1] = 1e-3F;  // the other is pushed in
  motion.show(stateAt(1.0, moved));
  EXPECT_FLOAT_EQ(motion.glow()[5], 1.0F);
  EXPECT_NEAR(motion.glow()[4], std::pow(0.5F, 0.75F), 1e-4F) << "one of its two links";
  EXPECT_EQ(motion.glow()[3], 0.0F);
  EXPECT_NEAR(motion.glow()[0], -std::pow(0.5F, 0.75F), 1e-4F);
  std::vector<float> turned;  // the row as a whole, by a right angle about its first module
  for (int i = 0; i < 6; ++i) {
    turned.insert(turned.end(),
                  {0.01F * static_cast<float>(i), -0.01F * static_cast<float>(i), 0.0F});
  }
  motion.glowBy(GlowBy::kTension);
  motion.show(stateAt(2.0, turned));
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(motion.glow()[i], 0.0F, 0.05F);
  }
}

TEST(ModelMotionTest, EachQuantityGlowsByItsOwn) {
  StructureMaker maker;
  maker.string(5, 0.0F);
  ModelMotion motion(maker.structure, shapeOf(maker.structure));
  const auto glowOf = [&](GlowBy quantity) {
    motion.glowBy(quantity);
    motion.show(stateAt(2.0, {0.0F, 1e-3F, 2e-3F, 3e-3F, 0.0F}));
    motion.show(stateAt(2.1, {0.0F, 1e-3F, 2e-3F, 3.5e-3F, 1e-3F}));
    return motion.glow();
  };
  EXPECT_NEAR(glowOf(GlowBy::kDisplacement)[2], std::pow(2.0 / 3.5, 0.75), 1e-3);
  // The end was 3 mm away from its neighbour 0.1 s before.
  EXPECT_NEAR(glowOf(GlowBy::kForce)[2], std::pow(0.25 / (3.0 * std::exp(-0.1 / 4.0)), 0.75), 1e-3);
  EXPECT_EQ(glowOf(GlowBy::kSpeed)[2], 0.0F);
  EXPECT_NEAR(glowOf(GlowBy::kSpeed)[3], std::pow(0.5, 0.75), 1e-3);
  EXPECT_NEAR(glowOf(GlowBy::kEnergy)[3], std::pow(0.25, 0.75), 1e-3);
  EXPECT_NEAR(glowOf(GlowBy::kTension)[2], std::pow(1.25 / (3.0 * std::exp(-0.1 / 4.0)), 0.75),
              1e-3)
      << "in one dimension either way is as far";
  EXPECT_EQ(glowOf(GlowBy::kNothing)[3], 0.0F);
}

}  // namespace
}  // namespace ergotic::panel
