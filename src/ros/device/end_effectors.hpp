// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <ergotic/EndEffector.h>
#include <geometry_msgs/Pose.h>

#include "ergotic/tgr/end_effector.hpp"

/// Conversion between end-effectors and their messages.
namespace ergotic::node {

geometry_msgs::Pose toPose(const Eigen::Isometry3d& pose);

EndEffector toMessage(const tgr::EndEffectorConfig& config);
std::vector<EndEffector> toMessages(const tgr::EndEffectors& end_effectors);

/// Numbers at 0 that the message says may be left out become the usual ones.
/// \throws TextError with name, value and allowed range; its place is in the YAML that says the
/// same
tgr::EndEffectors fromMessages(const std::vector<EndEffector>& messages);

}  // namespace ergotic::node
