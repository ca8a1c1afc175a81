// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace ergotic::panel {

/// Direction and field of view of a camera, as that of rviz which orbits around a point.
struct Look {
  double yaw = 0.0;             ///< rad, direction of the camera from the point
  double pitch = 0.0;           ///< rad
  double field_of_view = 0.79;  ///< rad, from the lower to the upper edge
  double aspect = 1.0;          ///< width over height of the picture
};

struct Framing {
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();  ///< point around which the camera orbits, m
  double distance = 1.0;                            ///< distance from there, m
};

/// A camera at a place, and what it looks at. \pre they are not one place
struct Shot {
  Eigen::Vector3d from;
  Eigen::Vector3d at;
};
/// Direction of a camera that takes this shot; field of view and aspect are unchanged.
Look lookOf(const Shot& shot, Look look);

/// Computes the camera that shows all points, with a margin around them.
/// \param points  at least one, finite
Framing frame(const std::vector<Eigen::Vector3d>& points, const Look& look);

}  // namespace ergotic::panel
