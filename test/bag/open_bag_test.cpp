// SPDX-License-Identifier: BSD-3-Clause
// Bags that several threads open and free at the same time.
#include "bag/open_bag.hpp"

#include <thread>
#include <vector>

#include <rosbag/bag.h>
#include <std_msgs/Float64.h>

#include "support/test.hpp"

namespace ergotic::bag {
namespace {

TEST(OpenBagTest, SeveralThreadsMayOpenBagsAtOnce) {
  const std::string path = testing::TempDir() + "ergotic_open_bag.bag";
  {
    const BagPointer bag = openToWrite(path);
    bag->write("x", ::ros::Time(1.0), std_msgs::Float64());
  }
  constexpr int kThreads = 4;
  constexpr int kTimes = 25;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&path] {
      for (int k = 0; k < kTimes; ++k) {
        EXPECT_GT(openToRead(path)->getSize(), 0U);
        EXPECT_THROW(openToRead(path + ".missing"), rosbag::BagException);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  std::remove(path.c_str());
}

}  // namespace
}  // namespace ergotic::bag
