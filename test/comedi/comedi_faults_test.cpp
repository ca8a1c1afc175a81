// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "comedi/comedi_rig.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::test {
namespace {

class ComediFaultsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    rig_.driver().open(1000.0);
    for (int n = 0; n < 5; ++n) {
      ASSERT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
    }
  }
  ComediRig rig_;
};

TEST_F(ComediFaultsTest, FlagsInputsThatAShortListLeftOut) {
  const Volts before = rig_.inputs;
  ComediRig::inject(ComediFault::kShort, 4);
  EXPECT_EQ(rig_.exchange(2.0), tgr::kMissingSample);
  EXPECT_NE(rig_.inputs[0], before[0]) << "was read";
  EXPECT_EQ(rig_.inputs[1], before[1]) << "was not";
  EXPECT_EQ(rig_.inputs[2], before[2]);
  EXPECT_NEAR(comediStandinOutputVolts(1), 2.0, kVoltsPerCount);
  EXPECT_EQ(rig_.exchange(2.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, FlagsOutputsThatAShortListLeftOut) {
  const Volts before = rig_.inputs;
  ComediRig::inject(ComediFault::kShort, 2);
  EXPECT_EQ(rig_.exchange(2.0), tgr::kMissingSample | tgr::kWriteFailed);
  EXPECT_EQ(rig_.inputs, before);
  EXPECT_NEAR(comediStandinOutputVolts(1), 1.0, kVoltsPerCount) << "slice 2";
}

TEST_F(ComediFaultsTest, FlagsAnErrorAsNothingReadAndNothingWritten) {
  const Volts before = rig_.inputs;
  ComediRig::inject(ComediFault::kError, 0.0, 3);
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(rig_.exchange(2.0), tgr::kMissingSample | tgr::kWriteFailed);
    EXPECT_EQ(rig_.inputs, before);
  }
  EXPECT_EQ(rig_.exchange(2.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, GivesTheRailOfAnInputAsItsHighestVolts) {
  ComediRig::inject(ComediFault::kRail);
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
  EXPECT_EQ(rig_.inputs[1], 10.0) << "slice 1 is at channel 0";
}

TEST_F(ComediFaultsTest, GivesTheVeryVoltsOfAStuckInput) {
  ComediRig::inject(ComediFault::kStuck, 0.0, 10);
  const Volts before = rig_.inputs;
  for (int n = 0; n < 10; ++n) {
    EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
    EXPECT_EQ(rig_.inputs[1], before[1]);
    EXPECT_NE(rig_.inputs[0], before[0]);
  }
}

TEST_F(ComediFaultsTest, BearsASlowList) {
  ComediRig::inject(ComediFault::kSlow, 0.02);
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, SaysThatAnUnpluggedBoardIsLostUntilReconnected) {
  ComediRig::inject(ComediFault::kUnplug);
  const Volts before = rig_.inputs;
  for (int n = 0; n < 5; ++n) {
    EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost);
    EXPECT_EQ(rig_.inputs, before);
  }
  EXPECT_THROW(rig_.driver().reconnect(), DeviceError) << "still away";
  EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost);
  comediStandinPlugIn();
  EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost) << "nobody asked for it";
  rig_.driver().reconnect();
  EXPECT_NEAR(comediStandinOutputVolts(0), 0.0, kVoltsPerCount) << "safe, until an exchange";
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, FindsABoardThatComesBackByItself) {
  ComediRig::inject(ComediFault::kUnplug, 1e-6);
  EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost);
  while (rig_.exchange(1.0) == tgr::kDeviceLost) {
    try {
      rig_.driver().reconnect();
    } catch (const DeviceError&) {  // not yet
    }
  }
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, MakesSafeALostBoardForWhenItComesBack) {
  ComediRig::inject(ComediFault::kUnplug);
  rig_.exchange(1.0);
  rig_.driver().makeSafe();
  comediStandinPlugIn();
  rig_.driver().reconnect();
  EXPECT_EQ(rig_.exchange(1.0), tgr::kMadeSafe);
  EXPECT_EQ(comediStandinOutputVolts(0), comediVolts(kMidCount));
  rig_.driver().rearm();
  EXPECT_EQ(rig_.exchange(1.0), tgr::kExchangeOk);
}

TEST_F(ComediFaultsTest, ReconnectLeavesABoardAloneThatIsWellOrClosed) {
  rig_.driver().reconnect();
  EXPECT_EQ(ComediRig::counters().opened, 1);
  EXPECT_NEAR(comediStandinOutputVolts(0), 1.0, kVoltsPerCount);
  rig_.driver().close();
  rig_.driver().reconnect();
  EXPECT_EQ(ComediRig::counters().opened, 1);
  EXPECT_EQ(rig_.exchange(1.0), tgr::kDeviceLost);
}

TEST_F(ComediFaultsTest, MakesSafeWithoutWaitingForATick) {
  EXPECT_NEAR(comediStandinOutputVolts(0), 1.0, kVoltsPerCount);
  rig_.driver().makeSafe();
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_EQ(comediStandinOutputVolts(channel), comediVolts(kMidCount));
  }
}

}  // namespace
}  // namespace ergotic::test
