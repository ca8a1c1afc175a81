// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Common parts of parallel linkages on slices that move along z: rods of one length from each
/// slice to a platform above.
namespace ergotic::tgr {

/// Workspace limit: least z of a rod over its length. A flatter rod transmits no force of its
/// slice.
constexpr double kFlattestRod = 0.2;
/// Workspace limit, as kFlattestRod, at rest.
constexpr double kFlattestRodAtRest = 0.3;
/// Workspace limit: the Jacobian's Frobenius norm over that at rest. It grows without bound where
/// the rods cannot hold the platform any more.
constexpr double kMaxGain = 3.0;

/// Height of the platform over slices at rest.
/// \param offset  horizontal distance between the ends of a rod, m
/// \throws Exception if the rods are too short
double restHeight(double rod, double offset);

}  // namespace ergotic::tgr
