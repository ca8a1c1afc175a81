// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/frames.hpp"

#include "ergotic/tgr/urdf.hpp"
#include "support/test.hpp"

namespace ergotic::node {
namespace {

TEST(FramesTest, ASliceMovesAlongZFromWhereTheUrdfHasIt) {
  SliceFrames frames(3, FrameNames());
  station::Snapshot snapshot;
  snapshot.slices = 3;
  snapshot.slice_position = {0.0, 0.004, -0.002};
  const auto transforms = frames.at(snapshot, ::ros::Time(7.0));
  ASSERT_EQ(transforms.size(), 3U);
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    const auto& transform = transforms[i];
    const Eigen::Vector3d rest = tgr::slicePlace(static_cast<int>(i), 3);
    EXPECT_EQ(transform.header.frame_id, "tgr_base");
    EXPECT_EQ(transform.header.stamp, ::ros::Time(7.0));
    EXPECT_EQ(transform.child_frame_id, "tgr_slice_" + std::to_string(i));
    EXPECT_EQ(transform.transform.translation.x, rest.x());
    EXPECT_EQ(transform.transform.translation.y, rest.y());
    EXPECT_EQ(transform.transform.translation.z, rest.z() + snapshot.slice_position[i]);
    EXPECT_EQ(transform.transform.rotation.w, 1.0);
  }
}

TEST(FramesTest, AllStandBehindThePrefixOfTheStation) {
  const FrameNames names("left");
  EXPECT_EQ(names("model"), "left/model");
  SliceFrames frames(1, names);
  const auto slice = frames.at(station::Snapshot(), ::ros::Time(1.0)).front();
  EXPECT_EQ(slice.header.frame_id, "left/tgr_base");
  EXPECT_EQ(slice.child_frame_id, "left/tgr_slice_0");
  const auto model = modelFrame(names, ::ros::Time(1.0));
  EXPECT_EQ(model.header.frame_id, "left/tgr_base");
  EXPECT_EQ(model.child_frame_id, "left/model");
  EXPECT_EQ(model.transform.translation.x, tgr::modelPose().translation().x());
}

}  // namespace
}  // namespace ergotic::node
