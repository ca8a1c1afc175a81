// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/grab_geometry.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace ergotic::panel {
namespace {

/// Looks along -x from (1, y, z).
Ray rayAt(double y, double z) {
  return {{1.0, y, z}, {-1.0, 0.0, 0.0}};
}

/// A string's section of one dimension, whose x is up in the picture and drawn five times as large:
/// a mass, and a key that slice 3 moves; and a mallet in a section of space, of end-effector
/// `stick`.
ModelStructure structure() {
  ModelStructure structure;
  structure.section_dimensions = {1, 3};
  structure.section_poses.resize(2);
  const double half = std::sqrt(0.5);
  structure.section_poses[0].orientation.w = half;
  structure.section_poses[0].orientation.y = -half;
  structure.section_poses[0].position.z = 0.2;
  structure.section_poses[1].orientation.w = 1.0;
  structure.module_sections = {0, 0, 1};
  structure.rest_positions = {0, 0, 0.2F, 0, 0.1F, 0.19F, 0.3F, 0.3F, 0.3F};
  return structure;
}

Handles handles() {
  Handles handles;
  handles.display_zoom = 5.0;
  handles.names = {"key", "mallet"};
  handles.modules = {1, 2};
  handles.end_effectors = {"", "stick"};
  handles.indices = {3, -1, -1, 0, 1, 2};
  handles.scales = {0.5, 1, 1, 2, 2, 2};
  handles.offsets = {0.001, 0, 0, 0, 0, 0};
  return handles;
}

HandleSet shown() {
  HandleSet set;
  set.show(structure());
  set.show(handles());
  return set;
}

TEST(HandleSetTest, PlacesHandlesWhereTheyAreDrawn) {
  HandleSet set = shown();
  ASSERT_EQ(set.handles().size(), 2U);
  EXPECT_TRUE(set.handles()[0].place().isApprox(Eigen::Vector3d(0.0, 0.1, 0.15), 1e-6))
      << "0.01 m below the string, drawn five times as far";
  ModelState state;
  state.displacement = {0.0F, 0.004F, 0.01F, 0.0F, -0.02F};
  set.show(state);
  EXPECT_TRUE(set.handles()[0].place().isApprox(Eigen::Vector3d(0.0, 0.1, 0.17), 1e-6));
  EXPECT_TRUE(set.handles()[1].place().isApprox(Eigen::Vector3d(0.31, 0.3, 0.28), 1e-6));
}

TEST(HandleSetTest, ModulesThatCanBeHeldAreWhereTheyAreDrawn) {
  HandleSet set;
  set.show(structure());
  Handles message = handles();
  set.show(message);
  EXPECT_EQ(set.modules(), 0U) << "an older station does not say which";
  message.can_be_held = {1, 0, 1};
  set.show(message);
  ModelState state;
  state.displacement = {0.01F, 0.004F, 0.01F, 0.0F, -0.02F};
  set.show(state);
  std::vector<std::size_t> modules;
  set.forEachModule([&](std::size_t module, const Eigen::Vector3d& place, const auto& at_rest) {
    modules.push_back(module);
    EXPECT_TRUE(place.isApprox(set.moduleAt(module).place()));
    EXPECT_TRUE(at_rest.isApprox(set.places()[module]));
  });
  EXPECT_THAT(modules, testing::ElementsAre(0U, 2U));
  EXPECT_TRUE(set.moduleAt(0).place().isApprox(Eigen::Vector3d(0.0, 0.0, 0.25), 1e-6));
  EXPECT_EQ(set.moduleAt(0).axes(), 1);
  EXPECT_EQ(set.moduleAt(2).axes(), 3);
}

TEST(GrabTest, AModuleIsHeldItself) {
  HandleSet set;
  set.show(structure());
  Handles message = handles();
  message.can_be_held = {1, 1, 1};
  set.show(message);
  Grab grab(set, set.moduleAt(0), rayAt(0.0, 0.2), {0.0, 1.0, 0.0});
  grab.drag().move(rayAt(0.0, 0.25), 1.0);
  const HoldTarget target = grab.target();
  EXPECT_EQ(target.module, 0);
  EXPECT_NEAR(target.target[0], 0.01, 1e-6) << "0.05 m in a picture that shows five times as much";
  EXPECT_EQ(target.target[1], 0.0);
}

TEST(HandleSetTest, KnowsWhereAllModulesAreDrawnAlsoOfAModelWithoutHandles) {
  HandleSet set;
  set.show(structure());
  EXPECT_TRUE(set.places().empty()) << "how large x is drawn is not known";
  Handles none;
  none.display_zoom = 5.0;
  set.show(none);
  const std::vector<Eigen::Vector3d> places = set.places();
  ASSERT_EQ(places.size(), 3U);
  EXPECT_TRUE(places[0].isApprox(Eigen::Vector3d(0.0, 0.0, 0.2), 1e-6));
  EXPECT_TRUE(places[1].isApprox(Eigen::Vector3d(0.0, 0.1, 0.15), 1e-6));
  EXPECT_TRUE(places[2].isApprox(Eigen::Vector3d(0.3, 0.3, 0.3), 1e-6));
  EXPECT_EQ(set.models(), 1);
}

TEST(HandleTest, ItsLabelSaysHowFarItIsFromRest) {
  Handle handle;
  handle.name = "key";
  handle.displacement = {-0.00125, 0.0, 0.0};
  EXPECT_EQ(handle.label(), "key  -1.25 mm");
  handle.displacement.x() = 0.01;
  EXPECT_EQ(handle.label(), "key  +10.00 mm");
  handle.displacement.x() = -1e-7;
  EXPECT_EQ(handle.label(), "key  0.00 mm");
  handle.dimensions = 3;
  handle.displacement = {0.003, 0.0, -0.004};
  EXPECT_EQ(handle.label(), "key  5.00 mm");
}

TEST(HandleSetTest, KnowsTheCameraThatASceneWantsIfItIsWhole) {
  ModelStructure message = structure();
  HandleSet set;
  set.show(message);
  EXPECT_TRUE(set.camera().empty());
  message.camera.resize(2);
  set.show(message);
  EXPECT_TRUE(set.camera().empty()) << "it looks at itself";
  message.camera[0].z = 2.0;
  set.show(message);
  ASSERT_EQ(set.camera().size(), 2U);
  EXPECT_EQ(set.camera()[0], Eigen::Vector3d(0.0, 0.0, 2.0));
  message.camera[1].x = std::nan("");
  set.show(message);
  EXPECT_TRUE(set.camera().empty());
}

TEST(HandleSetTest, ModesOfABodyThatHasAnOutlineAreNotDrawn) {
  ModelStructure body = structure();
  body.module_names = {"plate.0", "plate.outline.0", "plate.edge"};
  body.module_types = {ModelStructure::CELL, ModelStructure::POINT, ModelStructure::POINT};
  HandleSet set;
  set.show(body);
  set.show(handles());
  EXPECT_EQ(set.places().size(), 2U);
  EXPECT_TRUE(set.places().front().isApprox(Eigen::Vector3d(0.0, 0.1, 0.15), 1e-6));
}

TEST(HandleSetTest, WhatIsOfAnotherModelIsPassedOver) {
  HandleSet set;
  set.show(handles());
  EXPECT_TRUE(set.handles().empty()) << "no structure yet";
  ModelStructure smaller = structure();
  smaller.module_sections.pop_back();
  smaller.rest_positions.resize(6);
  set.show(smaller);
  EXPECT_TRUE(set.handles().empty()) << "the mallet is not in it";
  set.show(structure());
  ModelState state;
  state.displacement = {1.0F};
  set.show(state);
  EXPECT_EQ(set.handles()[0].displacement.x(), 0.0);
}

TEST(HandleSetTest, AStructureThatIsNotWholeHasNoHandles) {
  const auto shows = [](const ModelStructure& structure) {
    HandleSet set;
    set.show(handles());
    set.show(structure);
    return !set.handles().empty();
  };
  EXPECT_TRUE(shows(structure()));
  ModelStructure broken = structure();
  broken.module_sections[0] = 7;
  EXPECT_FALSE(shows(broken));
  broken = structure();
  broken.section_poses.pop_back();
  EXPECT_FALSE(shows(broken));
  broken = structure();
  broken.section_dimensions[0] = 9;
  EXPECT_FALSE(shows(broken));
}

TEST(GrabTest, AHandleOfOneAxisFollowsTheMouseAlongIt) {
  const HandleSet set = shown();
  Grab grab(set, set.handles()[0], rayAt(0.1, 0.15), {-1.0, 0.0, 0.0});
  grab.drag().move(rayAt(0.3, 0.20), 1.0);  // 0.05 m up in the picture, and sideways
  EXPECT_NEAR(grab.drag().displacement().x(), 0.01, 1e-9);
  const HandTargets wanted = grab.targets();
  EXPECT_EQ(wanted.end_effector, "");
  EXPECT_EQ(wanted.indices, (std::vector<std::uint32_t>{3}));
  ASSERT_EQ(wanted.targets.size(), 1U);
  EXPECT_NEAR(wanted.targets[0], 0.5 * 0.01 + 0.001, 1e-9);
  EXPECT_NEAR(grab.stretchFrom(Eigen::Vector3d::Zero()), 0.005, 1e-9);
}

TEST(GrabTest, AHandleOfThreeAxesFollowsTheMouseInThePlaneThatFacesTheCamera) {
  const HandleSet set = shown();
  Grab grab(set, set.handles()[1], rayAt(0.3, 0.3), {-1.0, 0.0, 0.0});
  grab.drag().move(rayAt(0.32, 0.29), 1.0);
  EXPECT_TRUE(grab.drag().displacement().isApprox(Eigen::Vector3d(0.0, 0.02, -0.01), 1e-9));
  grab.drag().push(0.005);  // away from the camera
  EXPECT_NEAR(grab.drag().displacement().x(), -0.005, 1e-9);
  const HandTargets wanted = grab.targets();
  EXPECT_EQ(wanted.end_effector, "stick");
  EXPECT_EQ(wanted.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_NEAR(wanted.targets[1], 0.04, 1e-9);
}

TEST(GrabTest, FineMotionIsAShareOfTheMouses) {
  const HandleSet set = shown();
  Grab grab(set, set.handles()[1], rayAt(0.3, 0.3), {-1.0, 0.0, 0.0});
  grab.drag().move(rayAt(0.4, 0.3), 0.1);
  grab.drag().move(rayAt(0.41, 0.3), 1.0);
  EXPECT_NEAR(grab.drag().displacement().y(), 0.01 + 0.01, 1e-9);
}

TEST(GrabTest, AnAxisThatPointsAtTheEyeMovesNothing) {
  const HandleSet set = shown();
  const Ray from_above{{0.0, 0.1, 2.0}, {0.0, 0.0, -1.0}};
  Grab grab(set, set.handles()[0], from_above, {0.0, 0.0, -1.0});
  grab.drag().move({{0.001, 0.1, 2.0}, {0.0, 0.0, -1.0}}, 1.0);
  EXPECT_EQ(grab.drag().displacement().x(), 0.0);
}

TEST(GrabTest, TargetsStayWithinWhatAHandMayWant) {
  const HandleSet set = shown();
  Grab grab(set, set.handles()[0], rayAt(0.1, 0.15), {-1.0, 0.0, 0.0});
  grab.drag().move(rayAt(0.1, 100.0), 1.0);
  EXPECT_EQ(grab.targets().targets[0], 0.1);
}

TEST(GrabTest, AllPointsOfAnEndEffectorGoTheSameWay) {
  Handles both = handles();
  both.end_effectors = {"stick", "stick"};
  HandleSet set;
  set.show(structure());
  set.show(both);
  Grab grab(set, set.handles()[1], rayAt(0.3, 0.3), {-1.0, 0.0, 0.0});
  grab.drag().move(rayAt(0.32, 0.3), 1.0);
  EXPECT_EQ(grab.targets().indices.size(), 4U);
}

TEST(PullTest, IsThatOfASpringUpToTheMostThatAHandGives) {
  EXPECT_DOUBLE_EQ(pullOf(1500.0, 10.0, 0.002), 3.0);
  EXPECT_DOUBLE_EQ(pullOf(1500.0, 10.0, 0.1), 10.0);
}

}  // namespace
}  // namespace ergotic::panel
