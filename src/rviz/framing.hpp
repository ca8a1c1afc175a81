// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace ergotic::panel {

/// How a camera looks, as that of rviz which orbits around a point.
struct Look {
  double yaw = 0.0;             ///< rad, of the camera as seen from the point
  double pitch = 0.0;           ///< rad
  double field_of_view = 0.79;  ///< rad, from the lower to the upper edge
  double aspect = 1.0;          ///< width over height of the picture
};

struct Framing {
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();  ///< around which the camera orbits, m
  double distance = 1.0;                            ///< from there, m
};

/// A camera at a place, and what it looks at. \pre they are not one place
struct Shot {
  Eigen::Vector3d from;
  Eigen::Vector3d at;
};
/// How a camera looks that takes this shot; field of view and aspect stay as they were.
Look lookOf(const Shot& shot, Look look);

/// Puts all points into the picture, with a margin around them and no more.
/// \param points  at least one, finite
Framing frame(const std::vector<Eigen::Vector3d>& points, const Look& look);

}  // namespace ergotic::panel
