// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include "ros/conversation/operator.hpp"

namespace ergotic::node {

/// Sets `robot_description`, beside the node, to a picture of its device and end-effectors, for
/// whoever starts to look or looks anew. Asks the master, who may take his time or be gone.
/// Thread: any, but never the operator's
void setDescription(const ::ros::NodeHandle& private_node, Operator& operator_thread);

}  // namespace ergotic::node
