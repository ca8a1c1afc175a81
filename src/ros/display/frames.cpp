// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/frames.hpp"

#include "ergotic/tgr/urdf.hpp"
#include "ros/device/end_effectors.hpp"

namespace ergotic::node {

geometry_msgs::Transform toTransform(const Eigen::Isometry3d& pose) {
  const geometry_msgs::Pose from = toPose(pose);
  geometry_msgs::Transform transform;
  transform.translation.x = from.position.x;
  transform.translation.y = from.position.y;
  transform.translation.z = from.position.z;
  transform.rotation = from.orientation;
  return transform;
}

geometry_msgs::TransformStamped modelFrame(const FrameNames& names, const ::ros::Time& stamp) {
  geometry_msgs::TransformStamped frame;
  frame.header.stamp = stamp;
  frame.header.frame_id = names("tgr_base");
  frame.child_frame_id = names("model");
  frame.transform = toTransform(tgr::modelPose());
  return frame;
}

SliceFrames::SliceFrames(int slices, const FrameNames& names) {
  for (int i = 0; i < slices; ++i) {
    const Eigen::Vector3d place = tgr::slicePlace(i, slices);
    rest_z_ = place.z();
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = names("tgr_base");
    transform.child_frame_id = names("tgr_slice_" + std::to_string(i));
    transform.transform = toTransform(Eigen::Isometry3d(Eigen::Translation3d(place)));
    transforms_.push_back(transform);
  }
}

const std::vector<geometry_msgs::TransformStamped>& SliceFrames::at(
    const station::Snapshot& snapshot, const ::ros::Time& stamp) {
  for (std::size_t i = 0; i < transforms_.size(); ++i) {
    transforms_[i].header.stamp = stamp;
    transforms_[i].transform.translation.z = rest_z_ + snapshot.slice_position[i];
  }
  return transforms_;
}

}  // namespace ergotic::node
