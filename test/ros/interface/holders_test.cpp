// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/holders.hpp"

#include <ergotic/HandTargets.h>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

HoldTarget target(int module, double x = 0.01) {
  HoldTarget wanted;
  wanted.module = module;
  wanted.target[0] = x;
  wanted.grip = HandTargets::FIRM;
  return wanted;
}

HoldTarget release(int module) {
  HoldTarget wanted = target(module);
  wanted.release = 1U;
  return wanted;
}

struct HoldersTest : testing::Test {
  void SetUp() override { holders.play(nullptr, {0, 1, 1, 1, 1, 1, 1}, 3150.0); }

  std::string refusalOf(const HoldTarget& wanted) {
    try {
      holders.read(wanted, "/mouse", 0.0);
    } catch (const Exception& refusal) {
      return refusal.what();
    }
    return "";
  }

  Holders holders;
};

TEST_F(HoldersTest, LaterTargetsOfAModuleMoveTheSameHand) {
  const auto first = holders.read(target(3), "/mouse", 0.0);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].hold.mat, 3);
  EXPECT_EQ(first[0].hold.goal[0], 0.01);
  EXPECT_EQ(first[0].hold.most_force, 10.0);
  EXPECT_NEAR(first[0].hold.ticks_left / 3150.0, 1.0 / 60.0, 1e-3);
  const auto second = holders.read(target(3, 0.02), "/mouse", 0.1);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].hand, first[0].hand);
}

TEST_F(HoldersTest, FourAreHeldAtOnceAndAFreeHandIsUsedAgain) {
  for (int module = 1; module <= 4; ++module) {
    EXPECT_EQ(holders.read(target(module), "/mouse", 0.0).size(), 1U);
  }
  EXPECT_EQ(refusalOf(target(5)), "the number of modules that are held is 5, allowed: at most 4");
  const auto let_go = holders.read(release(2), "/mouse", 0.0);
  ASSERT_EQ(let_go.size(), 1U);
  EXPECT_EQ(let_go[0].hold.mat, physics::Touch::kNothing);
  EXPECT_EQ(holders.read(target(5), "/mouse", 0.0)[0].hand, let_go[0].hand);
  EXPECT_THAT(holders.read(release(2), "/mouse", 0.0), IsEmpty()) << "it is not held any more";
}

TEST_F(HoldersTest, SendersLetGoOfTheirOwn) {
  holders.read(target(1), "/mouse", 0.0);
  holders.read(target(2), "/other", 0.0);
  EXPECT_THAT(holders.read(release(2), "/mouse", 0.0), IsEmpty());
  EXPECT_EQ(holders.read(release(-1), "/mouse", 0.0).size(), 1U);
  EXPECT_EQ(holders.read(release(-1), "/other", 0.0).size(), 1U);
}

TEST_F(HoldersTest, WhoFallsSilentLetsGo) {
  HoldTarget wanted = target(1);
  wanted.timeout = 1.0;
  holders.read(wanted, "/mouse", 10.0);
  holders.read(target(2), "/mouse", 10.0);  // without a timeout
  EXPECT_THAT(holders.expire(10.9), IsEmpty());
  holders.read(wanted, "/mouse", 10.9);
  EXPECT_THAT(holders.expire(11.5), IsEmpty());
  EXPECT_EQ(holders.expire(12.0).size(), 1U);
  EXPECT_THAT(holders.expire(13.0), IsEmpty());
}

TEST_F(HoldersTest, SaysWhatIsWrong) {
  EXPECT_EQ(refusalOf(target(7)), "module is 7, allowed: 0...6");
  EXPECT_EQ(refusalOf(target(-1)), "module is -1, allowed: 0...6");
  EXPECT_THAT(refusalOf(target(0)), testing::HasSubstr("allowed: what moves by itself"));
  EXPECT_EQ(refusalOf(target(1, std::nan(""))), "target is nan, allowed: -100...100 m");
  EXPECT_EQ(refusalOf(target(1, 101.0)), "target is 101, allowed: -100...100 m");
  HoldTarget wanted = target(1);
  wanted.grip = 5;
  EXPECT_EQ(refusalOf(wanted), "grip is 5, allowed: 0...4");
  wanted = target(1);
  wanted.timeout = -1.0;
  EXPECT_EQ(refusalOf(wanted), "timeout is -1, allowed: 0 or more seconds");
  EXPECT_EQ(holders.read(target(1), "/mouse", 0.0)[0].hand, 0U) << "nothing was taken by all that";
}

TEST_F(HoldersTest, NothingIsHeldWhereAPersonMayBeAtTheDevice) {
  holders.play(nullptr, {}, 3150.0);
  EXPECT_THAT(refusalOf(target(1)), testing::HasSubstr("a person may be at the device"));
  EXPECT_EQ(refusalOf(release(-1)), "");
}

TEST_F(HoldersTest, NothingOfAnotherModelIsHeld) {
  holders.read(target(1), "/mouse", 0.0);
  holders.play(nullptr, {1}, 3150.0);
  EXPECT_THAT(holders.read(release(-1), "/mouse", 0.0), IsEmpty());
  EXPECT_EQ(refusalOf(target(1)), "module is 1, allowed: 0...0");
}

}  // namespace
}  // namespace ergotic::node
