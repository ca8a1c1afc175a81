// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "rviz/model_graph.hpp"

namespace ergotic::panel {

/// A body of about radius 1 around the origin.
struct Solid {
  std::vector<Eigen::Vector3f> corners;
  std::vector<Eigen::Vector3f> normals;  ///< [corners] of length 1
  ModuleIndices triangles;               ///< [][3] corners
};

const Solid& ball();  ///< 42 corners
const Solid& box();   ///< 24 corners: each side has its own

}  // namespace ergotic::panel
