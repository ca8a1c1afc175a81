// SPDX-License-Identifier: BSD-3-Clause
// A station as it is deployed, a nodelet that a process loads, with a library preloaded that sees
// what its real-time threads do: no heap call, and no system call but the wait for the next tick.
#include <csignal>
#include <fstream>

#include <ergotic/ConfigureEndEffectors.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/HandTargets.h>
#include <ergotic/Hold.h>
#include <ergotic/HoldTarget.h>
#include <ergotic/InjectFault.h>
#include <ergotic/LoadModel.h>
#include <ergotic/SetParameter.h>
#include <ergotic/Status.h>
#include <ros/ros.h>

#include "integration/station_services.hpp"
#include "support/jack_server.hpp"
#include "support/places.hpp"
#include "support/realtime_scope.hpp"
#include "support/scratch_file.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

constexpr double kLongS = 60.0;  // a busy machine is slow
const std::string kWatched = "watched: a thread";

#ifdef ERGOTIC_SANITIZED  // under which a step takes about twenty times as long
constexpr int kMasses = 4;
#else
constexpr int kMasses = 12;
#endif

/// A wall beside two plates that sound, one for each of two threads.
std::string wallAndPlates(const std::string& name) {
  const std::string count = std::to_string(kMasses);
  const std::string size = "rows: " + count + ", columns: " + count;
  return "ergotic: 1\nname: " + name + R"(
parameters:
  stiffness: {value: 1000, range: [500, 1500]}
sections:
  hand: {rate: gestural}
  left: {rate: audio}
  right: {rate: audio}
mats:
  key: {type: slice, section: hand}
  ground: {type: ground, section: hand, at: [0, 0]}
generators:
  - {type: mesh, name: left, section: left, )" +
         size + R"(, spacing: 0.01, mass: 1.0e-4,
     stiffness: 2000, damping: 1.0e-3, edges: fixed}
  - {type: mesh, name: right, section: right, )" +
         size + R"(, spacing: 0.01, mass: 1.0e-4,
     stiffness: 2000, damping: 1.0e-3, edges: fixed}
lias:
  wall: {type: spring_damper, between: [key, ground], stiffness: $stiffness, damping: 2}
  strike: {type: contact, between: [key, left.1.1], stiffness: 100}
ports:
  key: {mat: key, slice: 0}
outputs:
  left: {at: left.2.2, quantity: velocity, channel: 1}
  right: {at: right.2.2, quantity: velocity, channel: 2}
)";
}

/// A station that is watched, with the sound of a JACK server.
class RealtimeTest : public ::testing::Test {
 protected:
  RealtimeTest() { jack_.start(); }

  void SetUp() override {
    node_.deleteParam("/station");
    node_.setParam("/station/model", wallAndPlates("first"));
    node_.setParam("/station/jack_wait", kLongS);
    node_.setParam("/station/jack_connect", false);
    node_.setParam("/station/ramp", 0.1);
    node_.setParam("/station/allow_fault_injection", true);
    allowStalls(node_);
    node_.setParam("/station/max_missing", 1000);  // of a busy machine
    node_.setParam("/station/max_load", 100.0);
  }
  void start(std::map<std::string, std::string> environment = {}) {
    environment["LD_PRELOAD"] = REALTIME_WATCH;
    environment[kRealtimeReport] = report_.path();
    environment["JACK_DEFAULT_SERVER"] = jack_.name();
    station_ = startStation(environment);
    ASSERT_TRUE(becomes("first"));
    ASSERT_TRUE(eventually([this] { return status_.latest().audio_running != 0U; }, kLongS))
        << status_.latest().message;
    ASSERT_TRUE(eventually([this] { return hand_.getNumSubscribers() > 0; }));
  }
  /// \return all that was seen
  std::vector<std::string> endAndRead() {
    station_->signal(SIGTERM);
    EXPECT_TRUE(station_->wait(kLongS)) << "it does not end";
    std::vector<std::string> lines;
    std::ifstream file(report_.path());
    for (std::string line; std::getline(file, line);) {
      lines.push_back(line);
    }
    return lines;
  }
  bool becomes(const std::string& model) const {
    return eventually([&] { return status_.latest().model == model; }, kLongS);
  }
  bool becomes(std::uint8_t state) const {
    return eventually([=] { return status_.latest().state == state; }, kLongS);
  }

  void play() {
    const auto isPlaying = [this] { return status_.latest().state == Status::PLAYING; };
    const auto begins = [&] {
      return call("recover").success != 0U && call("engage").success != 0U &&
             eventually(isPlaying, 2.0);
    };
    ASSERT_TRUE(eventually(begins, kLongS)) << status_.latest().state_text;
    for (const double target_m : {0.01, -0.01, 0.0}) {
      moveHand(hand_, 0, target_m);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  static void setParameter(double stiffness) {
    SetParameter set;
    set.request.name = "stiffness";
    set.request.value = stiffness;
    EXPECT_TRUE(::ros::service::call("/station/set_parameter", set));
    EXPECT_TRUE(set.response.success) << set.response.message;
  }
  void swapTo(const std::string& name) const {
    LoadModel load;
    load.request.model = wallAndPlates(name);
    EXPECT_TRUE(::ros::service::call("/station/load_model", load));
    EXPECT_TRUE(load.response.success) << load.response.message;
    EXPECT_TRUE(becomes(name));
  }
  static void putAKeyOnTheSlice() {
    ConfigureEndEffectors configure;
    configure.request.end_effectors.resize(1);
    configure.request.end_effectors[0].name = "key";
    configure.request.end_effectors[0].slices = {0};
    configure.request.end_effectors[0].ports = {"key"};
    EXPECT_TRUE(::ros::service::call("/station/configure_end_effectors", configure));
    EXPECT_TRUE(configure.response.success) << configure.response.message;
  }
  void inject(const std::string& kind, std::int64_t ticks, double amount) {
    SCOPED_TRACE(kind);
    play();
    InjectFault inject;
    inject.request.kind = kind;
    inject.request.slice = -1;
    inject.request.ticks = ticks;
    inject.request.amount = amount;
    EXPECT_TRUE(::ros::service::call("/station/inject_fault", inject));
    EXPECT_TRUE(inject.response.success) << inject.response.message;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }

  /// A hand holds a mass of a plate, goes with it, and lets go.
  void holdAndLetGo() {
    const Listener<Hold> told(node_, "/station/holds");
    HoldTarget target;
    target.module = 2 + kMasses + 1;  // behind key and ground: left.1.1
    const auto holds = [&](double place_m) {
      target.target[0] = place_m;
      hold_.publish(target);
      return eventually([&] { return told.count() > 0 && told.latest().module >= 0; }, 1.0);
    };
    EXPECT_TRUE(eventually([&] { return holds(0.001); }, kLongS)) << "nothing is held";
    EXPECT_TRUE(holds(-0.001));
    target.release = 1U;
    hold_.publish(target);
    EXPECT_TRUE(eventually([&] { return told.latest().module < 0; }, kLongS));
  }

  /// Whatever may be asked of a station while it plays.
  void askForEverything() {
    play();
    holdAndLetGo();
    setParameter(1200.0);
    {
      const Listener<GestureBlock> gesture(node_, "/station/gesture");  // asks for a keyframe
      swapTo("second");
      EXPECT_TRUE(eventually([&] { return gesture.count() > 5; }, kLongS));
    }
    play();
    putAKeyOnTheSlice();
    play();
    EXPECT_TRUE(call("stop").success);
    for (const char* const kind :
         {"not_a_number", "infinite", "frozen", "noise", "missing", "write_fails", "unplugged",
          "model_not_a_number", "model_blow_up", "model_active", "jack_lost"}) {
      inject(kind, 200, 0.001);
    }
    inject("jump", 1, 0.05);
    inject("rail", 200, 0.2);
    inject("stopped", 1, 0.05);
    play();
    EXPECT_TRUE(call("emergency_stop").success);
    EXPECT_TRUE(becomes(Status::FAULT));
    play();
  }

  const ScratchFile report_{""};
  JackServer jack_{"realtime"};
  ::ros::NodeHandle node_;
  Listener<Status> status_{node_, "/station/status"};
  ::ros::Publisher hand_ = node_.advertise<HandTargets>("/station/hand_targets", 10);
  ::ros::Publisher hold_ = node_.advertise<HoldTarget>("/station/hold_targets", 10);
  std::unique_ptr<ChildProcess> station_;
};

/// Which of these lines are not of a thread that begins to be watched.
std::string offences(const std::vector<std::string>& seen) {
  std::string text;
  for (const std::string& line : seen) {
    text += line == kWatched ? "" : line + '\n';
  }
  return text;
}

void expectWatched(const std::vector<std::string>& seen, int threads) {
  if (RealtimeScope::isAvailable()) {
    EXPECT_GE(std::count(seen.begin(), seen.end(), kWatched), threads);
  }
}

TEST_F(RealtimeTest, AStationWithOneThread) {
  ASSERT_NO_FATAL_FAILURE(start());
  askForEverything();
  const auto seen = endAndRead();
  EXPECT_EQ(offences(seen), "");
  expectWatched(seen, 2);  // the tick and JACK
}

TEST_F(RealtimeTest, AStationWithTwoThreads) {
  node_.setParam("/station/threads", 2);
  ASSERT_NO_FATAL_FAILURE(start());
  askForEverything();
  const auto seen = endAndRead();
  EXPECT_EQ(offences(seen), "");
  expectWatched(seen, 4);  // the tick, JACK, a worker of the first model and one of the second
}

TEST_F(RealtimeTest, AStationWhoseDeviceIsAnotherProcess) {
  const std::string segment = "/ergotic_realtime_" + std::to_string(getpid());
  ChildProcess device({toolPath("virtual_tgr"), "--shm", segment});
  node_.setParam("/station/virtual_shared_memory", segment);
  ASSERT_NO_FATAL_FAILURE(start());
  play();
  EXPECT_TRUE(call("emergency_stop").success);
  play();
  device.signal(SIGKILL);
  EXPECT_TRUE(becomes(Status::FAULT));
  const auto seen = endAndRead();
  EXPECT_EQ(offences(seen), "");
  expectWatched(seen, 2);
}

TEST_F(RealtimeTest, SeesWhatAThreadMayNotDo) {
  if (!RealtimeScope::isAvailable()) {
    GTEST_SKIP() << "under a sanitizer nothing is seen";
  }
  ASSERT_NO_FATAL_FAILURE(start({{"ERGOTIC_REALTIME_OFFEND", "1"}}));
  const std::string seen = offences(endAndRead());
  EXPECT_THAT(seen, HasSubstr("system call sched_yield\n"));
  EXPECT_THAT(seen, HasSubstr("heap call malloc\n"));
  EXPECT_THAT(seen, HasSubstr("heap call free\n"));
  EXPECT_THAT(seen, HasSubstr("libergotic_core.so")) << "on the way there";
}

}  // namespace
}  // namespace ergotic::test
