// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What parallel linkages on slices that move along z share: rods of one length from each slice to
/// a platform above.
namespace ergotic::tgr {

/// Workspace: z of every rod over its length. A flat rod can push its slice no more.
constexpr double kFlattestRod = 0.2;
/// The same at rest.
constexpr double kFlattestRodAtRest = 0.3;
/// Workspace: the Jacobian's Frobenius norm over that at rest. It grows without bound where the
/// rods cannot hold the platform any more.
constexpr double kMostGain = 3.0;

/// Height of the platform over slices at rest.
/// \param offset  horizontal distance between the ends of a rod, m
/// \throws Exception if the rods are too short
double restHeight(double rod, double offset);

}  // namespace ergotic::tgr
