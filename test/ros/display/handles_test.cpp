// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/handles.hpp"

#include "support/test.hpp"

namespace ergotic::node {
namespace {

/// A key on slice 0, and a mallet with a port for each axis.
scene::Scene keyAndMallet() {
  scene::Scene scene;
  scene.mats.resize(3);
  scene.mats[0].name = "string";
  scene.mats[1].name = "key";
  scene.mats[2].name = "mallet";
  scene::Port key;
  key.name = "strike";
  key.mat = 1;
  key.slice = 0;
  key.position_scale = 0.25;
  key.offset = -0.01;
  scene.ports = {key};
  for (int axis = 0; axis < 3; ++axis) {
    scene::Port port;
    port.name = std::string("mallet_") + "xyz"[axis];
    port.mat = 2;
    port.axis = axis;
    scene.ports.push_back(port);
  }
  scene.ports.back().slice = 1;
  return scene;
}

tgr::EndEffectors ball() {
  tgr::EndEffectorConfig config;
  config.name = "mallet";
  config.type = tgr::EndEffectorType::kBall;
  config.slices = {1, 2, 3};
  config.ports = {"mallet_x", "mallet_y", "mallet_z"};
  config.position_scale = 0.5;
  tgr::EndEffectors end_effectors;
  end_effectors.list = {config};
  return end_effectors;
}

TEST(HandlesTest, SlicesMoveWhatTheSceneGivesThem) {
  const Handles handles = handlesOf(keyAndMallet(), {});
  EXPECT_THAT(handles.names, ElementsAre("key", "mallet"));
  EXPECT_THAT(handles.modules, ElementsAre(1U, 2U));
  EXPECT_THAT(handles.end_effectors, ElementsAre("", ""));
  EXPECT_THAT(handles.indices, ElementsAre(0, -1, -1, -1, -1, 1));
  EXPECT_EQ(handles.scales[0], 0.25);
  EXPECT_EQ(handles.offsets[0], -0.01);
}

TEST(HandlesTest, EndEffectorsMoveWhatTheyHave) {
  const Handles handles = handlesOf(keyAndMallet(), ball());
  EXPECT_THAT(handles.names, ElementsAre("key", "mallet"));
  EXPECT_THAT(handles.end_effectors, ElementsAre("", "mallet"));
  EXPECT_THAT(handles.indices, ElementsAre(0, -1, -1, 0, 1, 2));
  EXPECT_EQ(handles.scales[4], 0.5);
}

TEST(HandlesTest, ASliceOfAnEndEffectorMovesNothingElse) {
  tgr::EndEffectors end_effectors = ball();
  end_effectors.list[0].slices = {0, 1, 2};
  EXPECT_THAT(handlesOf(keyAndMallet(), end_effectors).names, ElementsAre("mallet"));
}

}  // namespace
}  // namespace ergotic::node
