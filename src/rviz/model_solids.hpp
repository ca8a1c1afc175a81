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

// What touches the model at the origin, which lies along x from it. Along y goes what it touches;
// what holds it comes from the side of -z.
const Solid& key();
const Solid& hammer();    ///< a head on a shaft
const Solid& finger();    ///< its tip
const Solid& plectrum();  ///< a blade
const Solid& bow();       ///< hair that moves along x, and the stick

}  // namespace ergotic::panel
