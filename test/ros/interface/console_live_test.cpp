// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/console.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include <ros/console.h>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;

std::atomic<int> written{0};
std::chrono::milliseconds terminal_takes{0};

void countLine(void* /*logger*/,
               ::ros::console::Level /*level*/,
               const char* /*text*/,
               const char* /*file*/,
               const char* /*function*/,
               int /*number*/) {
  std::this_thread::sleep_for(terminal_takes);
  ++written;
}

/// Everything that is logged is counted instead of written.
class ConsoleTest : public ::testing::Test {
 protected:
  ConsoleTest() {
    ::ros::console::initialize();
    print_ = ::ros::console::backend::function_print;
    ::ros::console::backend::function_print = countLine;
    written = 0;
    terminal_takes = 0ms;
  }
  ~ConsoleTest() override { ::ros::console::backend::function_print = print_; }

 private:
  decltype(::ros::console::backend::function_print) print_;
};

TEST_F(ConsoleTest, WritesWhatWaitsBeforeItGoes) {
  terminal_takes = 2ms;
  {
    const auto console = Console::ofThisProcess();
    for (int i = 0; i < 20; ++i) {
      ROS_ERROR("%d", i);
    }
    EXPECT_LT(written, 20) << "who logs waits for the terminal";
  }
  EXPECT_EQ(written, 20);
}

TEST_F(ConsoleTest, OthersLogWhileTheLastStationGoes) {
  std::atomic<bool> ends{false};
  std::thread other([&] {
    while (!ends) {
      ROS_ERROR("of another nodelet");
    }
  });
  for (int i = 0; i < 300; ++i) {
    const auto console = Console::ofThisProcess();
    std::this_thread::sleep_for(100us);
  }
  ends = true;
  other.join();
  EXPECT_GT(written, 0);
}

}  // namespace
}  // namespace ergotic::node
