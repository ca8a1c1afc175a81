// SPDX-License-Identifier: BSD-3-Clause
// A station under 15 N loses its ROS master, and with it whoever could still ask for an emergency
// stop.
#include <std_srvs/Trigger.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <stdexcept>
#include <thread>

#include <ergotic/Status.h>
#include <netinet/in.h>
#include <ros/ros.h>
#include <sys/socket.h>

#include "integration/child_process.hpp"
#include "integration/pushed_station.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

using namespace std::chrono_literals;

// Longer than any watch needs to find a master that does not answer.
constexpr auto kLongSilence = 8s;

/// A TCP port of this machine that nobody uses.
int freePort() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof(address);
  if (bind(socket, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("no port left");
  }
  close(socket);
  return ntohs(address.sin_port);
}

class Master {
 public:
  Master() { start(); }
  int port() const { return port_; }
  void start() {
    process_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{"/usr/bin/rosmaster", "--core", "-p", std::to_string(port_)});
  }
  void kill() { process_.reset(); }
  void stop() const { process_->signal(SIGSTOP); }
  void goOn() const { process_->signal(SIGCONT); }

 private:
  const int port_ = freePort();
  std::unique_ptr<ChildProcess> process_;
};

std::unique_ptr<Master> the_master;  // of all tests

class MasterTest : public ::testing::Test {
 protected:
  void play(bool require_master) {
    node_.setParam("/station/require_master", require_master);
    station_ = std::make_unique<PushedStation>();
    ASSERT_TRUE(station_->isPushed()) << station_->status().state_text;
  }
  /// A connection that lasts: no master is asked when it is used.
  ::ros::ServiceClient connectTo(const std::string& service) {
    constexpr bool kPersistent = true;
    return node_.serviceClient<std_srvs::Trigger>("/station/" + service, kPersistent);
  }
  static bool call(::ros::ServiceClient& client) {
    std_srvs::Trigger trigger;
    EXPECT_TRUE(client.call(trigger)) << client.getService();
    return trigger.response.success != 0U;
  }
  void expectMasterIsMissed() {
    const auto before = std::chrono::steady_clock::now();
    ASSERT_TRUE(station_->becomes(Status::FAULT));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
    std::cout << "missed after " << took.count() << " s\n";
    EXPECT_EQ(station_->status().fault, Status::FAULT_MASTER_LOST) << station_->status().state_text;
    EXPECT_TRUE(eventually([this] { return station_->force() == 0.0; }));
  }

  ::ros::NodeHandle node_;
  std::unique_ptr<PushedStation> station_;
};

TEST_F(MasterTest, IsMissedWhenItHangsUntilItAnswers) {
  play(true);
  auto recover = connectTo("recover");
  auto engage = connectTo("engage");
  ASSERT_TRUE(recover.isValid() && engage.isValid());
  the_master->stop();
  expectMasterIsMissed();
  EXPECT_FALSE(call(recover));
  the_master->goOn();
  EXPECT_TRUE(eventually([&] { return call(recover) && call(engage); }));
  EXPECT_TRUE(station_->isPushed()) << station_->status().state_text;
}

TEST_F(MasterTest, IsNotMissedWhereNobodyRequiresIt) {
  play(false);
  the_master->stop();
  std::this_thread::sleep_for(kLongSilence);
  EXPECT_TRUE(station_->ticksOn());
  EXPECT_EQ(station_->status().state, Status::PLAYING) << station_->status().state_text;
  EXPECT_TRUE(station_->isPushed());
  the_master->goOn();
}

bool pretend(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  response.success = 1U;
  return true;
}

// Callers would then be told of a success by somebody who ends no force.
TEST_F(MasterTest, IsMissedWhenItLeadsToAnotherNodeThatTookAName) {
  for (const std::string name : {"stop", "emergency_stop"}) {
    play(true);
    auto recover = connectTo("recover");
    ASSERT_TRUE(recover.isValid());
    const ::ros::ServiceServer other = node_.advertiseService("/station/" + name, &pretend);
    expectMasterIsMissed();
    EXPECT_FALSE(call(recover)) << name;
    station_.reset();
  }
}

// Nobody's message would arrive.
TEST_F(MasterTest, IsMissedWhenItWasToldThatTheStationHearsNoEmergencyStop) {
  play(true);
  XmlRpc::XmlRpcValue request;
  request[0] = ::ros::this_node::getName();
  request[1] = "/station";
  XmlRpc::XmlRpcValue answer;
  XmlRpc::XmlRpcValue address;
  ASSERT_TRUE(::ros::master::execute("lookupNode", request, answer, address, false));
  request[0] = "/station";
  request[1] = "/station/emergency_stop";
  request[2] = address;
  ASSERT_TRUE(::ros::master::execute("unregisterSubscriber", request, answer, address, false));
  expectMasterIsMissed();
}

// The last: the new master does not know this test either.
TEST_F(MasterTest, IsMissedWhenItDiesAndNoNewOneTakesItsPlace) {
  play(true);
  auto recover = connectTo("recover");
  auto engage = connectTo("engage");
  ASSERT_TRUE(recover.isValid() && engage.isValid());
  the_master->kill();
  expectMasterIsMissed();
  the_master->start();
  ASSERT_TRUE(eventually([] { return ::ros::master::check(); }));
  std_srvs::Trigger refused;
  ASSERT_TRUE(recover.call(refused));
  EXPECT_FALSE(refused.response.success);
  EXPECT_THAT(refused.response.message, HasSubstr("the ROS master"));
  EXPECT_FALSE(call(engage));
  EXPECT_EQ(station_->status().fault, Status::FAULT_MASTER_LOST);
  EXPECT_EQ(station_->force(), 0.0);
  station_->process().signal(SIGTERM);
  EXPECT_TRUE(station_->process().wait(PushedStation::kLongS)) << "the station does not end";
}

}  // namespace
}  // namespace ergotic::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ergotic::test::the_master = std::make_unique<ergotic::test::Master>();
  const std::string uri = "http://127.0.0.1:" + std::to_string(ergotic::test::the_master->port());
  setenv("ROS_MASTER_URI", uri.c_str(), 1);
  ::ros::init(argc, argv, "master_rostest");
  ::ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
