// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <optional>

#include <ergotic/Status.h>
#include <ros/ros.h>

#include "integration/child_process.hpp"
#include "integration/device_log.hpp"
#include "integration/listener.hpp"
#include "integration/station_services.hpp"
#include "integration/wall.hpp"
#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::test {

/// A hand that a wall pushes with 15 N: its device in a process of its own, which notes the force,
/// a station in another. Settings are such that a stall of the machine is no fault.
class PushedStation {
 public:
  /// \param environment  of the station
  /// \param watchdog_ms  of the device
  /// \param model        kWall, or more
  /// \param watchdog_s   of the station, which beats for its guardian
  explicit PushedStation(const std::map<std::string, std::string>& environment = {},
                         double watchdog_ms = 2000.0,
                         const std::string& model = kWall,
                         double watchdog_s = 1.0) {
    node_.setParam("/station/model", model);
    node_.setParam("/station/virtual_shared_memory", segment_);
    node_.setParam("/station/jack", "none");
    node_.setParam("/station/ramp", 0.1);
    allowStalls(node_);
    node_.setParam("/station/watchdog", watchdog_s);
    node_.setParam("/station/max_missing", 1000);
    node_.setParam("/station/max_speed", 100.0);
    node_.setParam("/station/frozen", 0.0);
    node_.setParam("/station/autoengage", true);
    std::filesystem::create_directories(folder_);
    // A hand that is no deeper in the wall when force comes than the wall can push it back.
    std::ofstream(folder_ / "gesture.csv") << "time_s,slice,target_m\n0,0,0\n0.2,0,0.02\n";
    std::ofstream(folder_ / "hand.yaml")
        << "devices:\n  - driver: virtual\n    settings: {mechanics: "
           "{hand_stiffness: 3000, hand_damping: 30}}\n";
    device_ = std::make_unique<ChildProcess>(std::vector<std::string>{
        toolPath("virtual_tgr"), "--shm", segment_, "--device", (folder_ / "hand.yaml").string(),
        "--gesture", (folder_ / "gesture.csv").string(), "--log", log_.string(), "--priority", "70",
        "--watchdog-ms", std::to_string(watchdog_ms)});
    station_ = startStation(environment);
  }
  ~PushedStation() {
    station_.reset();
    endDevice();
    std::filesystem::remove_all(folder_);
  }
  PushedStation(const PushedStation&) = delete;
  PushedStation& operator=(const PushedStation&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  /// The file of the shared memory through which the station reaches its device.
  std::filesystem::path sharedMemory() const { return "/dev/shm" + segment_; }
  ChildProcess& process() { return *station_; }
  Status status() const { return statuses_.latest(); }
  std::size_t statuses() const { return statuses_.count(); }

  /// All that the device felt. It is gone then.
  std::vector<ForceRecord> feltToTheEnd() {
    EXPECT_EQ(endDevice(), 0);
    return device_log_.read();
  }
  /// What the device felt last, N.
  double force() {
    const auto& forces = device_log_.read();
    return forces.empty() ? 0.0 : forces.back().force_n;
  }
  /// When the force that the device felt became zero, CLOCK_MONOTONIC; nothing if it has not.
  std::optional<std::int64_t> releasedNs() {
    const auto& forces = device_log_.read();
    const bool is_free = !forces.empty() && forces.back().force_n == 0.0;
    return is_free ? std::optional(forces.back().time_ns) : std::nullopt;
  }
  /// Whether the device felt none for a moment at least.
  bool wasFreeSince(std::int64_t time_ns) {
    return eventually([=] {
      const auto& forces = device_log_.read();
      return std::any_of(forces.begin(), forces.end(), [=](const ForceRecord& at) {
        return at.time_ns >= time_ns && at.force_n == 0.0;
      });
    });
  }
  /// For a moment at least: where ticks stall all the time, force is never steady.
  bool wasPushed() {
    return eventually([this] { return force() < -0.95 * kForceN; }, kLongS);
  }
  bool isPushed() {
    return eventually([this] { return isSteady(device_log_.read(), -kForceN); }, kLongS);
  }
  bool becomes(std::uint8_t state) const {
    return eventually([&] { return statuses() > 0 && status().state == state; }, kLongS);
  }
  /// Whether two more reports come, of a station that plays on.
  bool ticksOn() const {
    const std::size_t before = statuses();
    const std::int64_t tick = status().ticks;
    return eventually([&] { return statuses() >= before + 2; }, kLongS) && status().ticks > tick;
  }
  static constexpr double kLongS = 60.0;  // a busy machine is slow

 private:
  /// \return its status
  std::optional<int> endDevice() {
    device_->signal(SIGTERM);
    return device_->wait(10.0);
  }

  const std::string segment_ = "/ergotic_pushed_" + std::to_string(getpid());
  const std::filesystem::path folder_ = std::filesystem::temp_directory_path() / segment_.substr(1);
  const std::filesystem::path log_ = folder_ / "forces.csv";
  ::ros::NodeHandle node_;
  Listener<Status> statuses_{node_, "/station/status"};
  DeviceLog device_log_{log_};
  std::unique_ptr<ChildProcess> device_;
  std::unique_ptr<ChildProcess> station_;
};

}  // namespace ergotic::test
