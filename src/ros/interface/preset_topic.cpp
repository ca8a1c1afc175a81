// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/preset_topic.hpp"

namespace ergotic::node {

PresetTopic::PresetTopic(const ::ros::NodeHandle& node) {
  constexpr bool kStays = true;
  ::ros::NodeHandle own(node);
  publisher_ = own.advertise<ergotic::Presets>("presets", 1, kStays);
  send();
}

void PresetTopic::show(const std::string& scene, const std::vector<std::string>& names) {
  message_.scene = scene;
  message_.names = names;
  send();
}

void PresetTopic::showUndo(bool can_undo) {
  if (can_undo != (message_.can_undo != 0U)) {
    message_.can_undo = can_undo ? 1U : 0U;
    send();
  }
}

void PresetTopic::showNothing() {
  message_ = {};
  send();
}

void PresetTopic::send() {
  message_.header.stamp = ::ros::Time::now();
  publisher_.publish(message_);
}

}  // namespace ergotic::node
