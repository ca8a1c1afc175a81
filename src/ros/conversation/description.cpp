// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/description.hpp"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>
#include <std_msgs/String.h>

#include "ergotic/tgr/urdf.hpp"

namespace ergotic::node {
namespace {

const char kName[] = "robot_description";
constexpr bool kLatched = true;

/// As the node remaps it.
std::string parameterBeside(const ::ros::NodeHandle& private_node) {
  const std::string beside = ::ros::names::parentNamespace(private_node.getNamespace());
  return private_node.resolveName(::ros::names::append(beside, kName));
}

}  // namespace

Description::Description(const ::ros::NodeHandle& private_node, Operator& operator_thread)
    : operator_(operator_thread),
      parameter_(parameterBeside(private_node)),
      topic_(::ros::NodeHandle(private_node).advertise<std_msgs::String>(kName, 1, kLatched)) {}

void Description::update() {
  const std::lock_guard lock(mutex_);
  const auto terms = operator_.terms();
  if (!terms) {
    return;
  }
  std_msgs::String urdf;
  urdf.data = tgr::urdfOf(terms->end_effectors, terms->slices);
  if (::ros::master::check()) {  // a parameter waits for a master for ever
    ::ros::param::set(parameter_, urdf.data);
  }
  topic_.publish(urdf);
}

}  // namespace ergotic::node
