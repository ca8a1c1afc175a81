// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/description.hpp"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>

#include "ergotic/tgr/urdf.hpp"

namespace ergotic::node {

void setDescription(const ::ros::NodeHandle& private_node, Operator& operator_thread) {
  const auto terms = operator_thread.terms();
  if (terms && ::ros::master::check()) {  // setParam waits for a master for ever
    const std::string beside = ::ros::names::parentNamespace(private_node.getNamespace());
    const std::string name = ::ros::names::append(beside, "robot_description");
    ::ros::param::set(private_node.resolveName(name),  // as the node remaps it
                      tgr::urdfOf(terms->end_effectors, terms->slices));
  }
}

}  // namespace ergotic::node
