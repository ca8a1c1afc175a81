// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "ergotic/tgr/end_effector.hpp"

namespace ergotic::tgr {

/// Picture of a device with its end-effectors, as URDF: links `tgr_base`, `model`, `tgr_slice_<i>`
/// with prismatic joints `slice_<i>`, and a link for each end-effector, named as it is, with a
/// floating joint `<name>_mount` whose transform from `tgr_base` is `EndEffectorConfig::pose *
/// Kinematics::pose(q)`. Slices of no end-effector carry the keys of a keyboard; slice 0 is its
/// lowest C.
/// \param slices  of the device, 1...kMaxSlices
std::string urdfOf(const EndEffectors& end_effectors, int slices);

/// Place of a slice at position 0 in that picture, in `tgr_base`, m; the slice moves along z.
/// \param index  of the slice, 0...slices - 1
Eigen::Vector3d slicePlace(int index, int slices);

/// Pose of the frame `model` in that picture, in `tgr_base`, m.
Eigen::Isometry3d modelPose();

}  // namespace ergotic::tgr
