// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "physics/network/network.hpp"

namespace ergotic::physics {

/// Stiffness of a section's own springs around the places where its modules rest, one row for each
/// coordinate of each free module; links to points and to other sections are left out, switching
/// ones too. K in kg/time_unit^2, at the softest end of its range.
Eigen::SparseMatrix<double> stiffnessOf(const Network& network, int section);

/// The coordinates that move, the others 0.
Eigen::Vector3d movingPart(const Eigen::Vector3d& v, scene::Geometry geometry);

}  // namespace ergotic::physics
