// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <std_srvs/Trigger.h>

#include <map>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ergotic/HandTargets.h>
#include <ergotic/Status.h>
#include <ros/ros.h>

#include "integration/child_process.hpp"
#include "integration/listener.hpp"
#include "support/test.hpp"

/// What every test asks of a station, `/station`, in a process of its own.

namespace ergotic::test {

/// \param environment  added to ours
inline std::unique_ptr<ChildProcess> startStation(
    const std::map<std::string, std::string>& environment = {}) {
  return std::make_unique<ChildProcess>(
      std::vector<std::string>{"/usr/lib/nodelet/nodelet", "standalone", "ergotic/Station",
                               "__name:=station"},
      environment);
}

/// To a test of something else a stall of the machine, of whatever length, is no fault of the
/// station; of the tests of stalls and watchdogs are `deployed`, `safety`, `pairs` and `force`.
/// \pre the station is not yet started
inline void allowStalls(const ::ros::NodeHandle& node) {
  node.setParam("/station/max_stall", 1.0);
  node.setParam("/station/max_stalls", 1'000'000);
  node.setParam("/station/watchdog", 1.0);
}

/// As at a device with a hand, though it is only simulated.
/// \pre the station is not yet started
inline void limitStalls(const ::ros::NodeHandle& node) {
  node.setParam("/station/max_stall", 0.05);
  node.setParam("/station/max_stalls", 3);
  node.setParam("/station/watchdog", 0.02);
}

/// Of a service without parameters. Over a connection that we end: of one that the server ends
/// roscpp may see the end before the answer (ros_comm issue 1976; one call of 5,000 on a busy
/// machine).
inline std_srvs::Trigger::Response call(const std::string& service) {
  constexpr bool kPersistent = true;
  std_srvs::Trigger trigger;
  auto client =
      ::ros::NodeHandle().serviceClient<std_srvs::Trigger>("/station/" + service, kPersistent);
  EXPECT_TRUE(client.call(trigger)) << service;
  return trigger.response;
}

inline void moveHand(const ::ros::Publisher& hand, std::uint32_t slice, double target_m) {
  HandTargets message;
  message.indices = {slice};
  message.targets = {target_m};
  hand.publish(message);
}

/// That from now on the diagnostics tell of the fault that the status tells of.
inline void expectDiagnosticsError(const Listener<diagnostic_msgs::DiagnosticArray>& diagnostics,
                                   const Listener<Status>& status) {
  const std::size_t before = diagnostics.count();
  EXPECT_TRUE(eventually([&] {
    const auto seen = diagnostics.messages();
    return std::any_of(seen.begin() + static_cast<std::ptrdiff_t>(before), seen.end(),
                       [&](const auto& array) {
                         const auto& force = array.status.front();
                         return force.level == diagnostic_msgs::DiagnosticStatus::ERROR &&
                                force.message == status.latest().state_text;
                       });
  }));
}

}  // namespace ergotic::test
