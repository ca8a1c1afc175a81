// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include "support/test.hpp"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ::ros::init(argc, argv, "rostest");
  ::ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
