// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <geometry_msgs/Pose.h>

namespace ergotic::panel {

/// Transform from a section to the picture, frame `model`, m.
/// \param zoom_of_x  magnification of x about x = 0, as the station's `display_zoom` says for
///                   sections whose modules move along x alone
inline Eigen::Affine3d drawingOf(const geometry_msgs::Pose& pose, double zoom_of_x) {
  const auto& q = pose.orientation;
  Eigen::Affine3d drawing = Eigen::Affine3d::Identity();
  drawing.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  drawing.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return drawing * Eigen::Scaling(zoom_of_x, 1.0, 1.0);
}

}  // namespace ergotic::panel
