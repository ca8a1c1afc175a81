// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ergotic/Cuts.h>
#include <ergotic/Handles.h>
#include <ergotic/Levels.h>
#include <ergotic/Scope.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "ergotic/station/station.hpp"
#include "ros/device/hands.hpp"
#include "ros/device/parameters.hpp"
#include "ros/display/display.hpp"
#include "ros/display/end_effector_frames.hpp"
#include "ros/interface/convert.hpp"
#include "ros/interface/gesture_blocks.hpp"
#include "ros/interface/take_writer.hpp"

namespace ergotic::node {

/// Publishers of all ROS topics of the station; pictures go through the thread of a `Display`.
/// Thread: command thread, all but the constructor
class Publishers {
 public:
  /// \param tf_prefix  of all frames; empty: none
  Publishers(const ::ros::NodeHandle& node, const std::string& tf_prefix);

  /// Shows that a station with these parameters and devices begins to play.
  void configure(const Parameters& parameters, const Hands& hands);
  /// Shows other end-effectors from now on.
  void show(const tgr::EndEffectors& end_effectors);
  /// Shows another model from now on.
  /// \param picture     its picture, not null
  /// \param parameters  its values, one for each
  void showModel(const station::Performer& performer,
                 std::shared_ptr<Picture> picture,
                 const std::string& note,
                 const std::vector<double>& parameters);
  /// Shows the modules that hands move from now on.
  void showHandles(Handles handles);
  /// \return whether `levels` has a subscriber
  bool wantsLevels() const { return levels_.getNumSubscribers() > 0; }
  void show(Levels levels);
  /// \return whether `scope` has a subscriber
  bool wantsScope() const { return scope_.getNumSubscribers() > 0; }
  void show(Scope scope);
  /// Shows the new value of a parameter of the model that plays.
  void showParameter(std::int64_t index, double value);
  /// Shows that nothing plays; `message` says why.
  void showSilence(const std::string& message);

  /// Adds a line to the message of the status.
  void addMessage(const std::string& line);

  /// \return what was sent
  Event show(const station::Event& event, const scene::Scene* scene);
  void showHold(const station::Event& event, const scene::Scene& scene);
  void show(const station::GestureTick* ticks, std::size_t count);
  /// \param uncalibrated  slices, a bit each
  void show(const station::Snapshot& snapshot, std::uint64_t uncalibrated);
  /// Shows that no ticks come, as then no snapshot reports that force is latched at zero.
  void showStandstill();
  void show(const station::MotionFrame& motion, const scene::Scene& scene);
  void show(const station::Keyframe& keyframe, const physics::Instrument& instrument);

  /// Shows another picture than that of the model that plays, whose motion is not shown until the
  /// next `showPicture` or `showModel`.
  void showPicture(std::shared_ptr<Picture> picture) { display_.show(std::move(picture)); }
  /// Shows a motion frame of the model of that picture.
  void showTake(const station::MotionFrame& motion) { display_.show(motion); }

  /// Also writes the messages of a performance into `take` from now on; null: stops that.
  void record(std::shared_ptr<TakeWriter> take);

  /// True once for each new subscriber of `gesture`, most likely a recorder.
  bool takeNewListener() { return new_listener_.exchange(false); }

  /// Sends the status if it is a second old, and parameters that have changed.
  void refresh();

  const Status& status() const { return status_; }

 private:
  template <class Message>
  void tell(::ros::Publisher& topic, const Message& message);
  void sendStatus();
  void sendParameters();
  void showCuts(Cuts cuts);
  void sendCuts(Cuts cuts);
  void watch(const station::MotionFrame& motion, const scene::Scene& scene);

  ::ros::NodeHandle node_;
  FrameNames names_;
  std::shared_ptr<TakeWriter> take_;  // null: none is recorded
  std::atomic<bool> new_listener_{false};
  std::string station_config_;
  std::int64_t motion_period_ns_ = 0;
  ::ros::Publisher joint_states_;
  ::ros::Publisher handles_;
  ::ros::Publisher holds_;
  ::ros::Publisher levels_;
  ::ros::Publisher scope_;
  double display_zoom_ = 1.0;
  ::ros::Publisher model_energy_;  // only if the energy accounts are kept
  ::ros::Publisher gesture_;
  ::ros::Publisher keyframe_;
  ::ros::Publisher events_;
  ::ros::Publisher status_topic_;
  ::ros::Publisher model_parameters_;
  ::ros::Publisher cuts_topic_;

  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;

  Status status_;
  ParametersMessage parameters_;
  bool parameters_changed_ = false;  // since they were sent
  std::int64_t parameters_due_ns_ = 0;
  std::string note_;  // of the model that plays; status_.message adds the latest news
  std::optional<GestureBlocks> blocks_;
  SliceFrames slice_frames_;
  EndEffectorFrames frames_;
  std::int64_t motion_due_ns_ = 0;
  std::int64_t status_due_ns_ = 0;
  Cuts cuts_;  // as they were sent
  std::int64_t cuts_due_ns_ = 0;
  Display display_;
};

}  // namespace ergotic::node
