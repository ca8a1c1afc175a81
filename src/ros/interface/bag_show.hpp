// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include <ergotic/Status.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "replay/replay.hpp"
#include "ros/display/display.hpp"
#include "ros/display/frames.hpp"
#include "ros/interface/description.hpp"

namespace ergotic::node {

/// Shows a recorded performance by the topics of a station, in its time: the model is built anew
/// from the bag and stepped through it, whatever pictures were recorded. It begins with the first
/// subscriber. Thread: any; it has one of its own
class BagShow {
 public:
  struct Settings {
    std::string bag;
    std::string station;  ///< name of the recorded station; empty: the only one
    std::string tf_prefix;
    double display_zoom = 5.0;
    bool loop = false;  ///< begins anew at the end
  };

  BagShow(const ::ros::NodeHandle& node, const Settings& settings);
  ~BagShow();  ///< within a picture
  BagShow(const BagShow&) = delete;
  BagShow& operator=(const BagShow&) = delete;

 private:
  void run();
  void playOnce();
  bool waitForOnlookers();
  void play(replay::Replay& replay);
  void showModel(const physics::Instrument& instrument);
  void showDevice(int slices);
  void showSlices(const std::vector<double>& positions);
  void tell(double seconds);
  bool sleepUntilNs(std::int64_t time_ns);

  Settings settings_;
  FrameNames names_;
  ::ros::NodeHandle node_;
  ::ros::Publisher status_topic_;
  ::ros::Publisher handles_;
  Description description_;
  Display display_;
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;

  // Of the thread:
  Status status_;
  tgr::EndEffectors end_effectors_;  // when the recording begins
  SliceFrames slice_frames_;
  EndEffectorFrames frames_;
  double length_s_ = 0.0;

  std::mutex mutex_;  // of what follows
  std::condition_variable woken_;
  bool quits_ = false;
  std::thread thread_;
};

}  // namespace ergotic::node
