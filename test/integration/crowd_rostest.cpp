// SPDX-License-Identifier: BSD-3-Clause
// Whether a station can be heard where little is left for it: of a processor, of a terminal.
#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include <arpa/inet.h>
#include <ergotic/SetParameter.h>
#include <netinet/in.h>
#include <ros/service_manager.h>
#include <std_msgs/Empty.h>
#include <sys/socket.h>

#include "ergotic/rt/clock.hpp"
#include "integration/child_process.hpp"
#include "integration/pushed_station.hpp"
#include "support/reference_threads.hpp"
#include "support/test.hpp"
#include "support/trials.hpp"

namespace ergotic::test {
namespace {

constexpr std::int64_t kLimitNs = 10'000'000;
constexpr double kWaitS = 5.0;  // for what comes at all

/// What this thread starts shares the last processor.
class OnOneProcessor {
 public:
  OnOneProcessor() {
    sched_getaffinity(0, sizeof usual_, &usual_);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sysconf(_SC_NPROCESSORS_ONLN) - 1, &one);
    EXPECT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  }
  ~OnOneProcessor() { sched_setaffinity(0, sizeof usual_, &usual_); }
  OnOneProcessor(const OnOneProcessor&) = delete;
  OnOneProcessor& operator=(const OnOneProcessor&) = delete;

 private:
  cpu_set_t usual_;
};

/// What this thread starts writes to a pipe that nobody reads.
class NobodyReads {
 public:
  NobodyReads() {
    constexpr int kBytes = 4096;
    EXPECT_EQ(pipe2(pipe_.data(), O_CLOEXEC), 0);
    EXPECT_GE(fcntl(pipe_[1], F_SETPIPE_SZ, kBytes), kBytes);
    for (std::size_t i = 0; i < usual_.size(); ++i) {
      const int output = static_cast<int>(i) + STDOUT_FILENO;
      usual_[i] = dup(output);
      dup2(pipe_[1], output);
    }
  }
  /// What was started goes on to write there.
  void restore() {
    for (std::size_t i = 0; i < usual_.size(); ++i) {
      dup2(usual_[i], static_cast<int>(i) + STDOUT_FILENO);
      close(usual_[i]);
    }
  }
  /// Whoever waits for a reader has waited long enough.
  ~NobodyReads() {
    close(pipe_[0]);
    close(pipe_[1]);
  }
  NobodyReads(const NobodyReads&) = delete;
  NobodyReads& operator=(const NobodyReads&) = delete;

 private:
  std::array<int, 2> pipe_{};
  std::array<int, 2> usual_{};
};

/// What roscpp refuses and complains of: a header of 1.5 GB, and one with a field that is too long.
const std::vector<std::string> kBadHeaders = {std::string("\x00\x2f\x68\x59", 4),
                                              std::string("\x08\0\0\0\x09\0\0\0abcd", 12)};

void sendHeader(std::uint16_t port, const std::string& header) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(send(fd, header.data(), header.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(header.size()));
  close(fd);
}

/// Calls as long as it lives what ordinary threads of a station answer.
class Talker {
 public:
  Talker() : thread_([this] { run(); }) {}
  ~Talker() {
    ends_ = true;
    thread_.join();
  }
  Talker(const Talker&) = delete;
  Talker& operator=(const Talker&) = delete;

 private:
  void run() {
    constexpr bool kPersistent = true;
    auto service =
        ::ros::NodeHandle().serviceClient<SetParameter>("/station/set_parameter", kPersistent);
    SetParameter unknown;
    while (!ends_ && service.call(unknown)) {
    }
  }

  std::atomic<bool> ends_{false};
  std::thread thread_;
};

// Whoever reads the sockets is urgent, and waits for ordinary threads that write their answers.
TEST(CrowdTest, AStopIsHeardOnOneProcessor) {
  constexpr int kStops = 10;
  std::optional<PushedStation> station;
  std::unique_ptr<ChildProcess> busy;
  {
    const OnOneProcessor crowded;
    station.emplace();
    busy = std::make_unique<ChildProcess>(
        std::vector<std::string>{"/bin/sh", "-c", "while :; do :; done"});
  }
  ASSERT_TRUE(station->wasPushed()) << station->status().state_text;
  constexpr bool kPersistent = true;
  auto button = ::ros::NodeHandle().serviceClient<std_srvs::Trigger>("/station/stop", kPersistent);
  std_srvs::Trigger stop;
  ASSERT_TRUE(button.call(stop));
  const Talker talker;
  const ReferenceThreads reference;
  Trials trials(reference, kStops);
  while (trials.goOn()) {
    ASSERT_TRUE(eventually([] { return call("engage").success != 0U; }, 30.0));
    ASSERT_TRUE(station->wasPushed()) << station->status().state_text;
    const std::int64_t asked_ns = rt::monotonicNs();
    ASSERT_TRUE(button.call(stop));
    EXPECT_TRUE(eventually([&] { return station->releasedNs().has_value(); }, kWaitS));
    trials.judge({asked_ns, asked_ns + kLimitNs}, station->releasedNs().value_or(Trials::kNever),
                 "its release");
  }
}

TEST(CrowdTest, AStationIsUnloadedInTheMiddleOfCalls) {
  constexpr int kTimes = 10;
  const std::string nodelet = "/usr/lib/nodelet/nodelet";
  ::ros::NodeHandle node;
  node.setParam("/station/model", kWall);
  node.setParam("/station/jack", "none");
  node.deleteParam("/station/virtual_shared_memory");
  ChildProcess manager({nodelet, "manager", "__name:=manager"});
  ASSERT_TRUE(::ros::service::waitForService("/manager/load_nodelet", 30000));
  for (int i = 0; i < kTimes && manager.isRunning(); ++i) {
    ChildProcess load({nodelet, "load", "ergotic/Station", "manager", "__name:=station"});
    ASSERT_TRUE(::ros::service::waitForService("/station/set_parameter", 30000));
    const Talker one;
    const Talker another;
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + 20 * (i % 10)));
    load.signal(SIGINT);  // it unloads what it has loaded
    ASSERT_TRUE(load.wait(30.0).has_value()) << "load " << i;
  }
  EXPECT_TRUE(manager.isRunning());
}

// As a terminal does that somebody holds by Ctrl-S.
TEST(CrowdTest, AStopIsHeardThoughNobodyReadsWhatIsLogged) {
  constexpr int kComplaints = 60;
  NobodyReads output;
  PushedStation station;
  output.restore();
  auto stop = ::ros::NodeHandle().advertise<std_msgs::Empty>("/station/emergency_stop", 1);
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  ASSERT_TRUE(eventually([&] { return stop.getNumSubscribers() > 0; }, kWaitS));
  std::string host;
  std::uint32_t port = 0;
  ASSERT_TRUE(::ros::ServiceManager::instance()->lookupService("/station/stop", host, port));
  for (int i = 0; i < kComplaints; ++i) {
    for (const std::string& header : kBadHeaders) {
      sendHeader(static_cast<std::uint16_t>(port), header);
    }
  }
  ASSERT_TRUE(station.isPushed()) << station.status().state_text;
  stop.publish(std_msgs::Empty());
  EXPECT_TRUE(eventually([&] { return station.releasedNs().has_value(); }, kWaitS));
  EXPECT_TRUE(station.becomes(Status::FAULT));
}

}  // namespace
}  // namespace ergotic::test
