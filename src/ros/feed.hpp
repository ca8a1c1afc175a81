// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "ergotic/station/station.hpp"
#include "ros/convert.hpp"
#include "ros/gesture_blocks.hpp"
#include "ros/markers.hpp"
#include "ros/parameters.hpp"

namespace ergotic::node {

/// Everything the station tells ROS. All but the constructor: operator thread.
class Feed {
 public:
  /// \param on_gesture_subscriber  called from a ROS thread when somebody starts to listen to
  ///                               `gesture`, most likely to record it
  Feed(::ros::NodeHandle& node,
       const Parameters& parameters,
       std::function<void()> on_gesture_subscriber);

  /// Another model plays from now on.
  void showModel(const station::Performer& performer, const std::string& note);
  /// Nothing plays any more, or nothing yet; `message` says why.
  void showSilence(const std::string& message);

  void show(const station::Event& event, const scene::Scene* scene);
  void show(const station::GestureTick* ticks, std::size_t count);
  void show(const station::Snapshot& snapshot);
  void show(const station::MotionFrame& motion);
  void show(const station::Keyframe& keyframe, const physics::Instrument& instrument);

  /// Sends the status if it is a second old.
  void refresh();

  const Status& status() const { return status_; }

 private:
  void sendStatus();

  std::string station_config_;
  double display_scale_;
  std::int64_t motion_period_ns_;
  ::ros::Publisher joint_states_;
  ::ros::Publisher model_structure_;
  ::ros::Publisher model_state_;
  ::ros::Publisher markers_topic_;
  ::ros::Publisher gesture_;
  ::ros::Publisher keyframe_;
  ::ros::Publisher events_;
  ::ros::Publisher status_topic_;

  Status status_;
  std::optional<GestureBlocks> blocks_;
  std::optional<Markers> markers_;
  std::int64_t motion_due_ns_ = 0;
  std::int64_t status_due_ns_ = 0;
};

}  // namespace ergotic::node
