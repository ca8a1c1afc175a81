// SPDX-License-Identifier: BSD-3-Clause
// What a station takes of its host, and what it tells of itself, as it is deployed: a process that
// loads a nodelet.
#include <filesystem>
#include <fstream>
#include <future>
#include <map>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ergotic/InjectFault.h>
#include <ergotic/LoadModel.h>
#include <ergotic/Status.h>
#include <ros/ros.h>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "integration/station_services.hpp"
#include "integration/wall.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

using namespace std::chrono_literals;
using Level = diagnostic_msgs::DiagnosticStatus;

constexpr int kTickPriority = 60;

class DeployedTest : public ::testing::Test {
 protected:
  void SetUp() override {
    node_.deleteParam("/station");
    node_.setParam("/station/model", kWall);
    node_.setParam("/station/jack", "none");
    node_.setParam("/station/priority", kTickPriority);
    node_.setParam("/station/allow_fault_injection", true);
    node_.setParam("/station/max_stall", 1.0);
  }
  void start() {
    station_ = startStation();
    ASSERT_TRUE(::ros::service::waitForService("/station/emergency_stop", 30000));
  }
  void startToPlay() {
    start();
    ASSERT_TRUE(eventually([this] { return status_.latest().model == "wall"; }));
  }
  std::filesystem::path proc() const {
    return std::filesystem::path("/proc") / std::to_string(station_->pid());
  }

  /// How many threads have which real-time priority.
  std::map<int, int> priorities() const {
    constexpr int kFieldAfterName = 38;  // of /proc/PID/task/TID/stat: rt_priority is field 40
    std::map<int, int> threads;
    for (const auto& task : std::filesystem::directory_iterator(proc() / "task")) {
      std::ifstream file(task.path() / "stat");
      std::string line;
      std::getline(file, line);
      std::istringstream fields(line.substr(line.rfind(')') + 1));
      std::string field;
      for (int n = 0; n < kFieldAfterName; ++n) {
        fields >> field;
      }
      ++threads[std::stoi(field)];
    }
    threads.erase(0);
    return threads;
  }
  long lockedKb() const {
    std::ifstream file(proc() / "status");
    for (std::string word; file >> word;) {
      if (word == "VmLck:") {
        file >> word;
        return std::stol(word);
      }
    }
    return -1;
  }
  /// Of the force, as the newest diagnostics say.
  int level() const {
    const auto newest = diagnostics_.latest();
    return newest.status.empty() ? -1 : newest.status.front().level;
  }

  ::ros::NodeHandle node_;
  Listener<Status> status_{node_, "/station/status"};
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics_{node_, "/diagnostics"};
  std::unique_ptr<ChildProcess> station_;
};

bool mayBeRealtime() {
  return std::async(std::launch::async, [] { return rt::makeRealtime(1).ok; }).get();
}

// It must not wait for a tick that never ends.
TEST_F(DeployedTest, WhatTakesForceAwayComesBeforeTheTick) {
  if (!mayBeRealtime()) {
    GTEST_SKIP() << "no right to real-time priorities";
  }
  startToPlay();
  ASSERT_TRUE(eventually([this] { return priorities().count(kTickPriority) > 0; }));
  const std::map<int, int> threads = priorities();
  const auto having = [&](int priority) {
    const auto found = threads.find(priority);
    return found == threads.end() ? 0 : found->second;
  };
  EXPECT_EQ(having(kTickPriority), 1) << "the tick";
  EXPECT_EQ(having(kTickPriority + 5), 1) << "the watchdog";
  EXPECT_EQ(having(80), 1) << "who hears signals";
  EXPECT_EQ(having(40), 2) << "who reads sockets, and who answers to stop";
  EXPECT_EQ(having(39), 1) << "who moves players' hands";
  EXPECT_EQ(threads.size(), 5U) << "and nobody else";
}

TEST_F(DeployedTest, ItsMemoryIsLockedUnlessItIsToldToBeOrdinary) {
  startToPlay();
  EXPECT_TRUE(eventually([this] {
    return lockedKb() > 10'000 || status_.latest().message.find("ulimit -l") != std::string::npos;
  })) << lockedKb()
      << " kB, " << status_.latest().message;
  station_.reset();
  node_.setParam("/station/realtime", "off");
  startToPlay();
  EXPECT_EQ(lockedKb(), 0);
}

TEST_F(DeployedTest, TheDiagnosticsOfAStationWithoutAModelAreAnErrorAndOfOneThatIsReadyAreNone) {
  node_.setParam("/station/model", "");
  start();
  ASSERT_TRUE(eventually([this] {
    return diagnostics_.count() > 0 && status_.latest().state == Status::DISCONNECTED;
  }));
  EXPECT_TRUE(eventually([this] { return level() == Level::ERROR; })) << level();
  LoadModel load;
  load.request.model = kWall;
  ASSERT_TRUE(::ros::service::call("/station/load_model", load));
  ASSERT_TRUE(load.response.success) << load.response.message;
  EXPECT_TRUE(eventually([this] {
    return status_.latest().state == Status::READY && level() == Level::OK;
  })) << level();
}

TEST_F(DeployedTest, AStallIsCountedAndTakesNoForceWhereTheDeviceIsOnlySimulated) {
  node_.deleteParam("/station/max_stall");  // nothing is said of stalls
  startToPlay();
  ASSERT_TRUE(eventually([] { return call("engage").success != 0U; }));
  ASSERT_TRUE(eventually([this] { return status_.latest().state == Status::PLAYING; }));
  const std::int64_t stalls = status_.latest().stalls;
  InjectFault slow;
  slow.request.kind = "slow";
  slow.request.amount = 0.1;  // s, of one tick
  constexpr int kStalls = 5;
  for (int n = 0; n < kStalls; ++n) {
    ASSERT_TRUE(::ros::service::call("/station/inject_fault", slow));
    ASSERT_TRUE(slow.response.success) << slow.response.message;
    std::this_thread::sleep_for(150ms);
  }
  EXPECT_TRUE(eventually([&] { return status_.latest().stalls >= stalls + kStalls; }));
  EXPECT_EQ(status_.latest().state, Status::PLAYING) << status_.latest().state_text;
}

TEST_F(DeployedTest, MoreStallsInASecondThanAreAllowedAreAFault) {
  node_.setParam("/station/max_stalls", 1);
  startToPlay();
  ASSERT_TRUE(eventually([] { return call("engage").success != 0U; }));
  ASSERT_TRUE(eventually([this] {
    return status_.latest().state == Status::PLAYING || status_.latest().state == Status::FAULT;
  }));
  InjectFault slow;
  slow.request.kind = "slow";
  slow.request.amount = 0.002;  // s, of one tick
  for (int n = 0; n < 2; ++n) {
    ASSERT_TRUE(::ros::service::call("/station/inject_fault", slow));
    ASSERT_TRUE(slow.response.success) << slow.response.message;
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_TRUE(eventually([this] { return status_.latest().state == Status::FAULT; }, 2.0));
  EXPECT_EQ(status_.latest().fault, Status::FAULT_STALL) << status_.latest().state_text;
}

// Each of those waits for an answer of the tick, for five seconds.
TEST_F(DeployedTest, AnEmergencyStopIsHeardWhileAllOthersWait) {
  startToPlay();
  InjectFault slow;
  slow.request.kind = "slow";
  slow.request.amount = 8.0;  // s, of one tick
  ASSERT_TRUE(::ros::service::call("/station/inject_fault", slow));
  ASSERT_TRUE(slow.response.success) << slow.response.message;
  std::vector<std::future<void>> waiting(8);
  for (std::future<void>& each : waiting) {
    each = std::async(std::launch::async, [] {
      std_srvs::Trigger engage;
      ::ros::service::call("/station/engage", engage);
    });
  }
  std::this_thread::sleep_for(300ms);
  for (const char* const request : {"emergency_stop", "stop"}) {
    const std::int64_t asked_ns = rt::monotonicNs();
    EXPECT_TRUE(call(request).success);
    EXPECT_LT(rt::monotonicNs() - asked_ns, 1'000'000'000) << request;
  }
  EXPECT_NE(waiting.front().wait_for(0s), std::future_status::ready) << "nobody had to wait";
  station_.reset();
}

}  // namespace
}  // namespace ergotic::test
