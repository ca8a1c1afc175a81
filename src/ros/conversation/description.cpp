// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/description.hpp"

#include <ros/master.h>
#include <ros/names.h>

#include "ergotic/tgr/urdf.hpp"

namespace ergotic::node {

void setDescription(const ::ros::NodeHandle& private_node, Operator& operator_thread) {
  const auto terms = operator_thread.terms();
  if (terms && ::ros::master::check()) {  // setParam waits for a master for ever
    const std::string beside = ::ros::names::parentNamespace(private_node.getNamespace());
    ::ros::NodeHandle(beside).setParam("robot_description",
                                       tgr::urdfOf(terms->end_effectors, terms->slices));
  }
}

}  // namespace ergotic::node
