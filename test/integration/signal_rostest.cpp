// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <thread>

#include <ergotic/ParameterValue.h>
#include <ros/network.h>
#include <sys/wait.h>
#include <xmlrpcpp/XmlRpc.h>

#include "ergotic/rt/clock.hpp"
#include "integration/pushed_station.hpp"
#include "support/reference_threads.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::test {
namespace {

constexpr std::int64_t kLimitNs = 10'000'000;

struct Try {
  std::int64_t signal_ns = 0;
  int exit_status = 0;
  std::vector<ForceRecord> forces;
};

/// One station under 15 N, what ends it, and what the device felt.
Try attempt(const std::function<void(PushedStation&)>& end) {
  PushedStation station;  // the watchdog of its device would take two seconds
  Try done;
  EXPECT_TRUE(station.isPushed()) << station.status().state_text;
  done.signal_ns = rt::monotonicNs();
  end(station);
  done.exit_status = station.process().wait(10.0).value_or(-1);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  done.forces = station.feltToTheEnd();
  return done;
}

class SignalTest : public ::testing::TestWithParam<int> {};

/// When force was zero for good. \pre there was force
std::int64_t releaseTime(const std::vector<ForceRecord>& forces) {
  return forces.back().force_n == 0.0 ? forces.back().time_ns : Trials::kNever;
}

/// With whatever roscpp gives.
void expectEndedByItself(int status) {
  EXPECT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
}

void expectUsualStatus(int signal, int status) {
  if (signal == SIGINT) {  // roscpp ends the program by itself
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  } else {
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
  }
}

void judgeRelease(Trials& trials, const Try& done, std::int64_t limit_ns) {
  ASSERT_FALSE(done.forces.empty());
  const std::int64_t released_ns = releaseTime(done.forces);
  ASSERT_NE(released_ns, Trials::kNever) << "force was never released";
  std::cout << "force gone after " << static_cast<double>(released_ns - done.signal_ns) * 1e-6
            << " ms\n";
  trials.judgeThat(forceAt(done.forces, done.signal_ns) < -0.95 * kForceN,
                   mutedBefore(done.signal_ns), "all of the force");
  trials.judge({done.signal_ns, done.signal_ns + limit_ns}, released_ns, "its release");
}

TEST_P(SignalTest, ReleasesFifteenNewtonsInTime) {
  const ReferenceThreads reference;
  Trials trials(reference);
  while (trials.goOn()) {
    const Try done = attempt([](PushedStation& station) { station.process().signal(GetParam()); });
    expectUsualStatus(GetParam(), done.exit_status);
    judgeRelease(trials, done, kLimitNs);
  }
}

/// Asks a node to end.
void shutDown(const std::string& node) {
  XmlRpc::XmlRpcValue request;
  request[0] = ::ros::this_node::getName();
  request[1] = node;
  XmlRpc::XmlRpcValue answer;
  XmlRpc::XmlRpcValue address;
  EXPECT_TRUE(::ros::master::execute("lookupNode", request, answer, address, false)) << node;
  std::string host;
  std::uint32_t port = 0;
  EXPECT_TRUE(::ros::network::splitURI(address, host, port));
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  request[1] = "a test ends it";
  EXPECT_TRUE(client.execute("shutdown", request, answer));
}

// As `rosnode kill` does, and a master that meets a second node of the name. roscpp looks at its
// sockets ten times a second at least, and only then whether it was told to end.
TEST(ShutdownTest, ReleasesFifteenNewtonsInTime) {
  constexpr std::int64_t kShutdownLimitNs = 150'000'000;
  const ReferenceThreads reference;
  Trials trials(reference);
  while (trials.goOn()) {
    const Try done = attempt([](PushedStation&) { shutDown("/station"); });
    judgeRelease(trials, done, kShutdownLimitNs);
    expectEndedByItself(done.exit_status);
  }
}

/// kWall, and a body of which each of so many parameters moves all links.
std::string wallAndParameters(int count) {
  std::string parameters = "parameters:\n";
  std::string stiffness;
  for (int i = 0; i < count; ++i) {
    const std::string name = "p" + std::to_string(i);
    parameters += "  " + name + ": {value: 1, range: [0.5, 1]}\n";
    stiffness += "  - {type: mesh, name: body_" + name + ", section: hand, rows: 4, columns: 4, " +
                 "spacing: 0.01, mass: 0.1, stiffness: $" + name + ", edges: corners}\n";
  }
  std::string model = kWall;
  model.insert(model.find("mats:"), parameters + "generators:\n" + stiffness);
  return model;
}

// The thread that prepares them has no time for anything else.
TEST(ShutdownTest, ReleasesFifteenNewtonsInTimeWhileParametersPourIn) {
  constexpr std::int64_t kShutdownLimitNs = 150'000'000;
  constexpr int kParameters = 64;
  ::ros::NodeHandle node;
  const ReferenceThreads reference;
  Trials trials(reference);
  while (trials.goOn()) {
    PushedStation station({}, 2000.0, wallAndParameters(kParameters));
    ASSERT_TRUE(station.wasPushed()) << station.status().state_text;
    ::ros::Publisher publisher = node.advertise<ParameterValue>("/station/parameters", 10000);
    ASSERT_TRUE(eventually([&] { return publisher.getNumSubscribers() > 0; }));
    std::atomic<bool> ends{false};
    std::thread flood([&] {
      for (int i = 0; !ends; ++i) {
        ParameterValue message;
        message.name = "p" + std::to_string(i % kParameters);
        message.value = 0.5 + 0.4 * (i % 7) / 7.0;
        publisher.publish(message);
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    Try done;
    done.signal_ns = rt::monotonicNs();
    shutDown("/station");
    const std::optional<int> status = station.process().wait(30.0);
    ends = true;
    flood.join();
    done.forces = station.feltToTheEnd();
    judgeRelease(trials, done, kShutdownLimitNs);
    ASSERT_TRUE(status) << "it does not end";
    expectEndedByItself(*status);
  }
}

/// The process that guards the devices of a station.
std::optional<pid_t> guardianOf(pid_t station) {
  const std::string parent = std::to_string(station);
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    std::ifstream stat(process.path() / "stat");
    std::string pid;
    std::string name;
    std::string state;
    std::string parent_found;
    if (stat >> pid >> name >> state >> parent_found && name == "(guardian)" && state != "Z" &&
        parent_found == parent) {
      return std::stoi(pid);
    }
  }
  return std::nullopt;
}

/// What befalls a guardian.
struct Loss {
  const char* name;
  int signal;
  bool is_refused;  ///< no other one can take its place
};

/// Where a new guardian would look for the device.
class HiddenDevice {
 public:
  explicit HiddenDevice(const PushedStation& station, bool hides)
      : from_(station.sharedMemory()), to_(hides ? from_.string() + "_away" : from_.string()) {
    std::filesystem::rename(from_, to_);
  }
  ~HiddenDevice() { show(); }
  HiddenDevice(const HiddenDevice&) = delete;
  HiddenDevice& operator=(const HiddenDevice&) = delete;
  void show() {
    if (from_ != to_) {
      std::filesystem::rename(to_, from_);
      to_ = from_;
    }
  }

 private:
  std::filesystem::path from_;
  std::filesystem::path to_;
};

class GuardianTest : public ::testing::TestWithParam<Loss> {
 protected:
  static constexpr double kWatchdogS = 0.02;
  static constexpr std::int64_t kGoneNs = 50'000'000;

  static bool says(const PushedStation& station, const std::string& what) {
    return eventually([&] { return station.status().message.find(what) != std::string::npos; },
                      PushedStation::kLongS);
  }
};

// The watchdog of the device would take two seconds, and nobody but the guardian could take the
// force away from it if the station died.
TEST_P(GuardianTest, WithoutOneThatWatchesThereIsNoForce) {
  const Loss& loss = GetParam();
  const ReferenceThreads reference;
  Trials trials(reference, std::getenv("ERGOTIC_LONG") != nullptr ? 20 : 1);
  while (trials.goOn()) {
    PushedStation station({}, 2000.0, kWall, kWatchdogS);
    ASSERT_TRUE(station.isPushed()) << station.status().state_text;
    const pid_t pid = station.process().pid();
    const auto first = guardianOf(pid);
    ASSERT_TRUE(first);
    HiddenDevice device(station, loss.is_refused);
    const std::int64_t lost_ns = rt::monotonicNs();
    kill(*first, loss.signal);
    EXPECT_TRUE(eventually([&] { return station.force() == 0.0; }, PushedStation::kLongS));
    const std::int64_t released_ns = station.releasedNs().value_or(Trials::kNever);
    std::cout << "force gone after " << static_cast<double>(released_ns - lost_ns) * 1e-6
              << " ms\n";
    trials.judge({lost_ns, lost_ns + kGoneNs}, released_ns, "the release without a guardian");
    EXPECT_TRUE(station.becomes(Status::FAULT));
    if (loss.is_refused) {
      EXPECT_TRUE(says(station, "there is no force until another can be started"))
          << station.status().message;
      EXPECT_FALSE(call("recover").success);
      device.show();
    }
    EXPECT_TRUE(says(station, "a guardian of the devices again")) << station.status().message;
    EXPECT_EQ(station.force(), 0.0) << "it waits for an operator";
    EXPECT_TRUE(eventually([] { return call("recover").success; }, PushedStation::kLongS));
    EXPECT_TRUE(call("engage").success);
    ASSERT_TRUE(station.isPushed()) << station.status().state_text;
    const std::int64_t killed_ns = rt::monotonicNs();
    station.process().signal(SIGKILL);
    EXPECT_TRUE(eventually([&] { return station.force() == 0.0; }, PushedStation::kLongS));
    trials.judge({killed_ns, killed_ns + kGoneNs}, station.releasedNs().value_or(Trials::kNever),
                 "the release by the new guardian");
  }
}

std::string nameOfLoss(const ::testing::TestParamInfo<Loss>& tested) {
  return tested.param.name;
}
INSTANTIATE_TEST_SUITE_P(Every,
                         GuardianTest,
                         ::testing::Values(Loss{"Killed", SIGKILL, false},
                                           Loss{"Stopped", SIGSTOP, false},
                                           Loss{"KilledAndRefused", SIGKILL, true}),
                         &nameOfLoss);

// ROS ends the first of two nodes with one name. The device is busy until that has closed it.
TEST(TwoStationsTest, TheSecondOfANameGetsTheDeviceOfTheFirst) {
  PushedStation station;
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  const std::int64_t second_ns = rt::monotonicNs();
  const auto second = startStation();
  ASSERT_TRUE(station.process().wait(PushedStation::kLongS).has_value()) << "the first plays on";
  EXPECT_TRUE(station.wasFreeSince(second_ns));
  EXPECT_TRUE(station.isPushed()) << station.status().message;
}

std::string nameOf(const ::testing::TestParamInfo<int>& tested) {
  return std::string("Sig") + sigabbrev_np(tested.param);
}
INSTANTIATE_TEST_SUITE_P(Every,
                         SignalTest,
                         ::testing::Values(SIGTERM, SIGINT, SIGHUP, SIGKILL, SIGSEGV, SIGABRT),
                         &nameOf);

}  // namespace
}  // namespace ergotic::test
