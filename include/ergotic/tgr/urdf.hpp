// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/tgr/end_effector.hpp"

namespace ergotic::tgr {

/// A picture of a device with what stands on it, as URDF: links `tgr_base`, `model`,
/// `tgr_slice_<i>` with prismatic joints `slice_<i>`, and a link for each end-effector, named as it
/// is, with a floating joint `<name>_mount` whose transform from `tgr_base` is
/// `EndEffectorConfig::pose * Kinematics::pose(q)`. Slices of no end-effector carry the keys of a
/// keyboard; slice 0 is its lowest C.
/// \param slices  of the device, 1...kMaxSlices
std::string urdfOf(const EndEffectors& end_effectors, int slices);

}  // namespace ergotic::tgr
