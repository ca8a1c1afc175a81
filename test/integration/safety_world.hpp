// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ergotic/Event.h>
#include <ergotic/SliceTarget.h>
#include <ergotic/Status.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>

#include "integration/child_process.hpp"
#include "integration/listener.hpp"

namespace ergotic::test {

// A wall of 1000 N/m; the hand (2000 N/m) wants to be 22.5 mm inside, and so meets 15 N at 15 mm.
inline const char kDevice[] = R"(devices:
  - driver: virtual
    settings: {mechanics: {hand_stiffness: 2000, hand_damping: 30}}
)";
inline const char kWall[] = R"(ergotic: 1
name: wall
sections:
  hand: {rate: gestural}
mats:
  key: {type: slice, section: hand}
  ground: {type: ground, section: hand, at: [0, 0]}
lias:
  wall: {type: spring_damper, between: [key, ground], stiffness: 1000, damping: 2}
ports:
  key: {mat: key, slice: 0}
)";
constexpr double kForceN = 15.0;
constexpr double kTargetM = 0.0225;
constexpr double kForceLimitN = 20.0;

/// Tells the station five times as often as it needs that somebody is there.
class PresenceSwitch {
 public:
  explicit PresenceSwitch(::ros::NodeHandle& node)
      : topic_(node.advertise<std_msgs::Bool>("/station/presence", 10)),
        timer_(node.createWallTimer(::ros::WallDuration(0.04), [this](const auto& /*event*/) {
          if (speaks_) {
            say(true);
          }
        })) {}
  void hold() { speaks_ = true; }
  void fallSilent() { speaks_ = false; }
  void release() {
    speaks_ = false;
    say(false);
  }

 private:
  void say(bool present) {
    std_msgs::Bool message;
    message.data = present ? 1U : 0U;
    topic_.publish(message);
  }
  ::ros::Publisher topic_;
  std::atomic<bool> speaks_{true};
  ::ros::WallTimer timer_;
};

/// A station under a wall, in a process of its own, and all that it tells.
struct SafetyWorld {
  SafetyWorld() {
    node.setParam("/station/model", kWall);
    node.setParam("/station/device", kDevice);
    node.setParam("/station/jack", "none");
    node.setParam("/station/ramp", 0.1);
    node.setParam("/station/presence", "topic");
    node.setParam("/station/allow_fault_injection", true);
    node.setParam("/station/force_limit", kForceLimitN);
    station = std::make_unique<ChildProcess>(std::vector<std::string>{
        "/usr/lib/nodelet/nodelet", "standalone", "ergotic/Station", "__name:=station"});
  }

  ::ros::NodeHandle node;
  Listener<Status> status{node, "/station/status"};
  Listener<Event> events{node, "/station/events"};
  Listener<sensor_msgs::JointState> joints{node, "/station/joint_states"};
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics{node, "/diagnostics"};
  ::ros::Publisher hand = node.advertise<SliceTarget>("/station/hand_target", 10);
  ::ros::Publisher stop = node.advertise<std_msgs::Empty>("/station/emergency_stop", 1);
  PresenceSwitch presence{node};
  std::unique_ptr<ChildProcess> station;
  std::vector<std::string> table;
};

}  // namespace ergotic::test
