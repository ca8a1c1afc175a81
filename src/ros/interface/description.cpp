// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/description.hpp"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>
#include <std_msgs/String.h>

#include "ergotic/tgr/urdf.hpp"

namespace ergotic::node {
namespace {

const char kDescriptionName[] = "robot_description";
constexpr bool kDescriptionIsLatched = true;

/// Name of the parameter in the parent namespace, as the node remaps it.
std::string parameterBeside(const ::ros::NodeHandle& private_node) {
  const std::string beside = ::ros::names::parentNamespace(private_node.getNamespace());
  return private_node.resolveName(::ros::names::append(beside, kDescriptionName));
}

}  // namespace

Description::Description(const ::ros::NodeHandle& private_node)
    : parameter_(parameterBeside(private_node)),
      topic_(::ros::NodeHandle(private_node)
                 .advertise<std_msgs::String>(kDescriptionName, 1, kDescriptionIsLatched)) {}

void Description::update(CommandThread& command_thread) {
  const std::lock_guard lock(mutex_);
  if (const auto terms = command_thread.terms()) {
    tell(terms->end_effectors, terms->slices);
  }
}

void Description::show(const tgr::EndEffectors& end_effectors, int slices) {
  const std::lock_guard lock(mutex_);
  tell(end_effectors, slices);
}

void Description::tell(const tgr::EndEffectors& end_effectors, int slices) {
  std_msgs::String urdf;
  urdf.data = tgr::urdfOf(end_effectors, slices);
  if (::ros::master::check()) {  // a parameter waits for a master for ever
    ::ros::param::set(parameter_, urdf.data);
  }
  topic_.publish(urdf);
}

}  // namespace ergotic::node
