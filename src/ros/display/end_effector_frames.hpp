// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <visualization_msgs/MarkerArray.h>

#include "ergotic/station/messages.hpp"
#include "ergotic/tgr/end_effector.hpp"
#include "ros/display/frames.hpp"

namespace ergotic::node {

/// Poses of end-effectors, for tf, and their shapes in their own frames, for rviz.
/// The frame of each has its name, behind the prefix of all frames, and `tgr_base` as its parent.
class EndEffectorFrames {
 public:
  EndEffectorFrames() = default;
  /// \throws TextError if one of them cannot be put together
  explicit EndEffectorFrames(const tgr::EndEffectors& end_effectors,
                             const FrameNames& names = FrameNames());

  /// Poses at a snapshot; beyond its workspace an end-effector stays at its last pose.
  const std::vector<geometry_msgs::TransformStamped>& at(const station::Snapshot& snapshot,
                                                         const ::ros::Time& stamp);
  const visualization_msgs::MarkerArray& shapes(const ::ros::Time& stamp);

 private:
  struct Part {
    tgr::EndEffectorConfig config;
    std::unique_ptr<tgr::Kinematics> kinematics;
  };
  std::vector<Part> parts_;
  std::vector<geometry_msgs::TransformStamped> transforms_;  // [parts]
  visualization_msgs::MarkerArray shapes_;
};

}  // namespace ergotic::node
