// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <std_srvs/Trigger.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <mutex>
#include <thread>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ergotic/Event.h>
#include <ergotic/HandTargets.h>
#include <ergotic/InjectFault.h>
#include <ergotic/Status.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>

#include "ergotic/rt/clock.hpp"
#include "integration/child_process.hpp"
#include "integration/device_log.hpp"
#include "integration/fault_table.hpp"
#include "integration/listener.hpp"
#include "integration/station_services.hpp"
#include "integration/wall.hpp"
#include "support/places.hpp"
#include "support/reference_threads.hpp"
#include "support/test.hpp"

namespace ergotic::test {

// The hand (2000 N/m) wants to be 22.5 mm inside the wall, and so meets 15 N at 15 mm. A stick on
// the other slices has no more than 60 degrees to either side.
inline const char kDevice[] = R"(devices:
  - driver: virtual
    settings: {slices: 3, mechanics: {hand_stiffness: 2000, hand_damping: 30}}
)";
inline const char kStick[] = R"(end_effectors:
  stick: {type: stick, slices: [1, 2], ports: [tip_x, tip_y], arm: 0.01, length: 0.05}
)";
constexpr double kTargetM = 0.0225;
constexpr double kForceLimitN = 20.0;
constexpr double kReachM = 0.01732;  // of slice 1, from where on the stick is tilted too far

/// Tells the station five times as often as it needs that somebody is there.
class PresenceSwitch {
 public:
  explicit PresenceSwitch(::ros::NodeHandle& node)
      : topic_(node.advertise<std_msgs::Bool>("/station/presence", 10)),
        timer_(node.createWallTimer(::ros::WallDuration(0.04), [this](const auto& /*event*/) {
          const std::lock_guard lock(mutex_);
          if (speaks_) {
            say(true);
          }
        })) {}
  void hold() {
    const std::lock_guard lock(mutex_);
    speaks_ = true;
  }
  void fallSilent() {
    const std::lock_guard lock(mutex_);
    speaks_ = false;
  }
  void release() {
    const std::lock_guard lock(mutex_);
    speaks_ = false;
    say(false);
  }
  /// Just before it spoke last, CLOCK_MONOTONIC.
  std::int64_t spokeNs() const {
    const std::lock_guard lock(mutex_);
    return spoke_ns_;
  }

 private:
  void say(bool present) {
    std_msgs::Bool message;
    message.data = present ? 1U : 0U;
    spoke_ns_ = rt::monotonicNs();
    topic_.publish(message);
  }
  mutable std::mutex mutex_;
  bool speaks_ = true;
  std::int64_t spoke_ns_ = 0;
  ::ros::Publisher topic_;
  ::ros::WallTimer timer_;
};

/// A device and a station, each in a process of its own, and all that they tell.
class SafetyWorld {
 public:
  SafetyWorld() {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "device.yaml") << kDevice;
    startDevice(kUsualWatchdogMs);
    node.setParam("/station/model", kWall);
    node.setParam("/station/device",
                  "devices:\n  - driver: virtual\n    settings: {slices: 3, shared_memory: " +
                      segment_ + "}\n" + kStick);
    node.setParam("/station/jack", "none");
    node.setParam("/station/ramp", 0.1);
    node.setParam("/station/presence", "topic");
    limitStalls(node);
    node.setParam("/station/max_stalls", 1'000'000);
    node.setParam("/station/allow_fault_injection", true);
    node.setParam("/station/force_limit", kForceLimitN);
    station = startStation();
  }
  ~SafetyWorld() {
    station.reset();  // it has the device open
    endDevice();
    std::filesystem::remove_all(folder_);
  }
  SafetyWorld(const SafetyWorld&) = delete;
  SafetyWorld& operator=(const SafetyWorld&) = delete;

  /// A device with another watchdog is another process; `recover` then finds it.
  void setDeviceWatchdog(double watchdog_ms) {
    if (watchdog_ms != watchdog_ms_) {
      endDevice();
      startDevice(watchdog_ms);
    }
  }

  void moveHand(std::uint32_t slice, double target_m) { test::moveHand(hand_, slice, target_m); }
  /// To where it meets 15 N, slowly: a device that pauses for some milliseconds must not make its
  /// positions jump further than a hand can move.
  void pushHand() {
    constexpr int kSteps = 10;
    for (int step = 1; step <= kSteps; ++step) {
      moveHand(0, kTargetM * step / kSteps);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  /// Whether the device felt 15 N for a while: longer than between two messages of the presence
  /// switch, so that also at the last of them there was all the force.
  bool isPushed() const { return isSteady(log->read(), -kForceN); }
  /// Until the hand meets 15 N. It comes from outside: a wall that appears where the hand already
  /// is may not push it away, for it never got the energy. \return false if that took too long
  bool push() {
    presence.hold();
    if (!eventually([] { return call("recover").success != 0U; }, kPatienceS)) {
      return false;  // a device that was started again is not there yet
    }
    log->forget();  // long before any fault, for what was felt just before one counts, too
    moveHand(0, 0.0);
    moveHand(1, 0.0);
    const bool engaged = eventually([this] { return isNear(0, 0.0); }, kPatienceS) &&
                         call("recover").success != 0U &&
                         eventually([] { return call("engage").success != 0U; }, kPatienceS) &&
                         stateBecomes(Status::PLAYING, kPatienceS);
    pushHand();
    return engaged && eventually([this] { return isPushed(); }, kPatienceS);
  }
  bool stateBecomes(std::uint8_t state, double seconds = 30.0) const {
    return eventually([=] { return status.latest().state == state; }, seconds);
  }
  bool handIsConnected() const { return hand_.getNumSubscribers() > 0; }
  double effort() const {
    const auto joints = joints_.latest();
    return joints.effort.empty() ? 0.0 : joints.effort.front();
  }
  bool isNear(std::size_t slice, double position_m) const {
    const auto joints = joints_.latest();
    return joints.position.size() > slice && std::abs(joints.position[slice] - position_m) < 0.001;
  }

  ::ros::NodeHandle node;
  Listener<Status> status{node, "/station/status"};
  Listener<Event> events{node, "/station/events"};
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics{node, "/diagnostics"};
  ::ros::Publisher stop = node.advertise<std_msgs::Empty>("/station/emergency_stop", 1);
  PresenceSwitch presence{node};
  std::unique_ptr<ChildProcess> station;
  std::unique_ptr<DeviceLog> log;  // of the present device
  const ReferenceThreads reference;
  const ReferenceThreads ordinary{ReferenceThreads::Rank::kOrdinary};
  FaultTable table;

 private:
  static constexpr double kUsualWatchdogMs = 10.0;
  static constexpr double kLongS = 60.0;  // a busy machine is slow
  static constexpr double kPatienceS = 5.0;

  void startDevice(double watchdog_ms) {
    const auto path = folder_ / ("forces_" + std::to_string(++devices_) + ".csv");
    device_ = std::make_unique<ChildProcess>(std::vector<std::string>{
        toolPath("virtual_tgr"), "--shm", segment_, "--device", (folder_ / "device.yaml").string(),
        "--log", path.string(), "--priority", "70", "--watchdog-ms", std::to_string(watchdog_ms)});
    log = std::make_unique<DeviceLog>(path);
    watchdog_ms_ = watchdog_ms;
  }
  /// A device that is killed leaves its shared memory behind.
  void endDevice() {
    device_->signal(SIGTERM);
    EXPECT_TRUE(device_->wait(kLongS)) << "the device does not end";
    device_.reset();
  }

  const std::string segment_ = "/ergotic_safety_" + std::to_string(getpid());
  const std::filesystem::path folder_ = std::filesystem::temp_directory_path() / segment_.substr(1);
  Listener<sensor_msgs::JointState> joints_{node, "/station/joint_states"};
  ::ros::Publisher hand_ = node.advertise<HandTargets>("/station/hand_targets", 10);
  std::unique_ptr<ChildProcess> device_;
  int devices_ = 0;
  double watchdog_ms_ = 0.0;
};

}  // namespace ergotic::test
