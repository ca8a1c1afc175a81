// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/parameter_watch.hpp"

#include <algorithm>

#include <ros/console.h>

namespace ergotic::node {
namespace {

using XmlRpc::XmlRpcValue;

constexpr double kLookS = 1.0;

bool hasEntries(const XmlRpcValue& value) {
  return value.valid() && value.getType() == XmlRpcValue::TypeStruct;
}

/// \param after  a copy: `XmlRpcValue` finds an entry only where it might add it
void addMissingIn(const XmlRpcValue& before, XmlRpcValue after, std::vector<std::string>& names) {
  if (!hasEntries(before)) {
    return;
  }
  for (const auto& entry : before) {
    if (!hasEntries(after) || !after.hasMember(entry.first) || after[entry.first] != entry.second) {
      names.push_back(entry.first);
    }
  }
}

}  // namespace

std::vector<std::string> changedNames(const XmlRpcValue& before, const XmlRpcValue& after) {
  std::vector<std::string> names;
  addMissingIn(before, after, names);
  addMissingIn(after, before, names);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

ParameterWatch::ParameterWatch(const ::ros::NodeHandle& node) : node_(node) {
  node_.getParamCached(node_.getNamespace(), known_);
  timer_ = node_.createWallTimer(::ros::WallDuration(kLookS),
                                 [this](const ::ros::WallTimerEvent&) { look(); });
}

/// Looks at the parameters. The master is asked only after it has reported a change.
void ParameterWatch::look() {
  XmlRpcValue now;
  node_.getParamCached(node_.getNamespace(), now);
  for (const std::string& name : changedNames(known_, now)) {
    ROS_WARN_STREAM("The parameter "
                    << node_.getNamespace() << '/' << name
                    << " was changed on the ROS master. The station reads its parameters when its "
                       "first model starts to play: if one plays already, start the station anew. "
                       "Parameters of the model are set by the service set_parameter.");
  }
  known_ = now;
}

}  // namespace ergotic::node
