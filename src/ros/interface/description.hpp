// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "ros/interface/command_thread.hpp"

namespace ergotic::node {

/// Picture of the device and its end-effectors, as URDF: the parameter `robot_description` beside
/// the node, for programs that start later, and then the topic of that name, for subscribers.
/// Thread: any, but never the command thread
class Description {
 public:
  explicit Description(const ::ros::NodeHandle& private_node);

  // Both ask the master, who may take his time or be gone.

  /// Publishes the present end-effectors, if anything plays.
  void update(CommandThread& command_thread);
  /// \param slices  of the device
  void show(const tgr::EndEffectors& end_effectors, int slices);

 private:
  void tell(const tgr::EndEffectors& end_effectors, int slices);

  std::string parameter_;
  ::ros::Publisher topic_;
  std::mutex mutex_;  // the newest comes last
};

}  // namespace ergotic::node
