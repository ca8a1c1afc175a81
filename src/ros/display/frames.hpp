// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <geometry_msgs/TransformStamped.h>

#include "ergotic/station/messages.hpp"

namespace ergotic::node {

/// Names of tf frames: `left/model` of a station with the prefix `left`, `model` of one without.
class FrameNames {
 public:
  /// \param prefix  without a slash at its end; empty: none
  explicit FrameNames(const std::string& prefix = "")
      : prefix_(prefix.empty() ? prefix : prefix + "/") {}

  std::string operator()(const std::string& frame) const { return prefix_ + frame; }

 private:
  std::string prefix_;
};

geometry_msgs::Transform toTransform(const Eigen::Isometry3d& pose);

/// Pose of `model` in `tgr_base`, constant.
geometry_msgs::TransformStamped modelFrame(const FrameNames& names, const ::ros::Time& stamp);

/// Poses of the slices of a device, for tf: `tgr_slice_<i>` in `tgr_base`, as its URDF says.
class SliceFrames {
 public:
  SliceFrames() = default;
  /// \param slices  of the device
  SliceFrames(int slices, const FrameNames& names);

  const std::vector<geometry_msgs::TransformStamped>& at(const station::Snapshot& snapshot,
                                                         const ::ros::Time& stamp);

 private:
  std::vector<geometry_msgs::TransformStamped> transforms_;  // [slices]
  double rest_z_ = 0.0;
};

}  // namespace ergotic::node
