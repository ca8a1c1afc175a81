// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/gate.hpp"

#include <gtest/gtest.h>

namespace ergotic::tgr {
namespace {

constexpr double kTick = 1.0 / 1024.0;  // a power of two: ramps add up exactly

class GateTest : public ::testing::Test {
 protected:
  Gate gate_{0.125, 0.03125, kTick};  // 128 and 32 ticks
};

TEST_F(GateTest, IsClosedAtFirst) {
  EXPECT_FALSE(gate_.isOpen());
  EXPECT_EQ(gate_.ramp(), 0.0);
}

TEST_F(GateTest, RampsInAStraightLine) {
  gate_.open();
  for (int n = 0; n <= 128; ++n) {
    ASSERT_EQ(gate_.next(), n / 128.0);
  }
  EXPECT_EQ(gate_.next(), 1.0);
  EXPECT_EQ(gate_.ramp(), 1.0);
}

TEST_F(GateTest, BeginsAtZeroEveryTime) {
  gate_.open();
  for (int n = 0; n < 50; ++n) {
    gate_.next();
  }
  gate_.open();
  EXPECT_EQ(gate_.next(), 50.0 / 128.0) << "it was open already";
  gate_.close();
  EXPECT_EQ(gate_.ramp(), 0.0);
  gate_.open();
  EXPECT_EQ(gate_.next(), 0.0);
}

TEST_F(GateTest, ResumesByTheShorterLineWithinTheLonger) {
  gate_.resume();
  EXPECT_FALSE(gate_.isOpen());
  gate_.open();
  for (int n = 0; n < 64; ++n) {
    gate_.next();
  }
  gate_.resume();
  EXPECT_EQ(gate_.next(), 0.0);
  EXPECT_EQ(gate_.next(), (65.0 / 128.0) / 32.0);
}

}  // namespace
}  // namespace ergotic::tgr
