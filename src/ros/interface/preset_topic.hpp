// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <ergotic/Presets.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

namespace ergotic::node {

/// The topic `presets`. Thread: command thread, all but the constructor
class PresetTopic {
 public:
  explicit PresetTopic(const ::ros::NodeHandle& node);

  /// \param scene  as `presetsOf`
  void show(const std::string& scene, const std::vector<std::string>& names);
  void showUndo(bool can_undo);
  /// Publishes that nothing plays.
  void showNothing();

 private:
  void send();

  ::ros::Publisher publisher_;
  ergotic::Presets message_;
};

}  // namespace ergotic::node
