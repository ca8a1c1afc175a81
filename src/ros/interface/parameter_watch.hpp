// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace ergotic::node {

/// Names of the entries of two maps of parameters that differ, sorted; one that is missing in a map
/// differs. What is no map has no entries.
std::vector<std::string> changedNames(const XmlRpc::XmlRpcValue& before,
                                      const XmlRpc::XmlRpcValue& after);

/// Warns when a parameter of the station is changed on the ROS master while it runs, as with
/// `rosparam set`: parameters are read only when the station starts. Thread: those of the node's
/// callbacks
class ParameterWatch {
 public:
  explicit ParameterWatch(const ::ros::NodeHandle& node);
  ParameterWatch(const ParameterWatch&) = delete;
  ParameterWatch& operator=(const ParameterWatch&) = delete;

 private:
  void look();

  ::ros::NodeHandle node_;
  XmlRpc::XmlRpcValue known_;
  ::ros::WallTimer timer_;
};

}  // namespace ergotic::node
