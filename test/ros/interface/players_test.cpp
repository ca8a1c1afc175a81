// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/players.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

tgr::EndEffectors ballOnSlices(std::vector<int> slices) {
  tgr::EndEffectorConfig ball;
  ball.name = "mallet";
  ball.type = tgr::EndEffectorType::kBall;
  ball.slices = std::move(slices);
  tgr::EndEffectors end_effectors;
  end_effectors.list = {ball};
  return end_effectors;
}

HandTargets slicesTo(std::vector<std::uint32_t> slices, std::vector<double> targets) {
  HandTargets wanted;
  wanted.indices = std::move(slices);
  wanted.targets = std::move(targets);
  return wanted;
}

TEST(PlayersTest, ReadsSlices) {
  Players players;
  HandTargets wanted = slicesTo({3, 5}, {0.01, -0.02});
  wanted.header.stamp = ::ros::Time(12, 500'000'000);
  wanted.grip = HandTargets::QUICK;
  wanted.timeout = 0.5;
  const auto moves = players.read(wanted, "/mouse", 7.0);
  ASSERT_EQ(moves.size(), 2U);
  EXPECT_EQ(moves[0].slice, 3);
  EXPECT_EQ(moves[0].target_m, 0.01);
  EXPECT_EQ(moves[1].slice, 5);
  EXPECT_EQ(moves[1].target_m, -0.02);
  for (const tgr::HandMove& move : moves) {
    EXPECT_EQ(move.time_s, 12.5);
    EXPECT_EQ(move.timeout_s, 0.5);
    EXPECT_EQ(move.grip, tgr::HandGrip::kQuick);
    EXPECT_FALSE(move.lets_go);
  }
}

TEST(PlayersTest, TargetsWithoutAStampAreOfNow) {
  Players players;
  EXPECT_EQ(players.read(slicesTo({0}, {0.0}), "/mouse", 7.0)[0].time_s, 7.0);
}

TEST(PlayersTest, BringsAnEndEffectorToItsCoordinates) {
  Players players;
  players.configure(ballOnSlices({4, 2, 7}));
  HandTargets wanted = slicesTo({0, 2}, {0.01, -0.005});
  wanted.end_effector = "mallet";
  const auto moves = players.read(wanted, "/mouse", 0.0);
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_EQ(moves[0].slice, 4);
  EXPECT_EQ(moves[1].slice, 2);
  EXPECT_EQ(moves[2].slice, 7);
  const auto kinematics = tgr::makeKinematics(ballOnSlices({4, 2, 7}).list[0], "");
  const double q[] = {moves[0].target_m, moves[1].target_m, moves[2].target_m};
  double x[3];
  double jacobian[9];
  ASSERT_TRUE(kinematics->forward(q, x, jacobian));
  EXPECT_NEAR(x[0], 0.01, 1e-9);
  EXPECT_NEAR(x[1], 0.0, 1e-9);
  EXPECT_NEAR(x[2], -0.005, 1e-9);
}

TEST(PlayersTest, CoordinatesThatAreNotNamedStay) {
  Players players;
  players.configure(ballOnSlices({0, 1, 2}));
  HandTargets wanted = slicesTo({0, 1}, {0.01, 0.004});
  wanted.end_effector = "mallet";
  const auto before = players.read(wanted, "/mouse", 0.0);
  wanted.indices = {0};
  wanted.targets = {0.01};
  const auto after = players.read(wanted, "/mouse", 0.0);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(after[i].target_m, before[i].target_m, 1e-9);
  }
}

TEST(PlayersTest, LettingGoOfNothingNamedLetsGoOfAllThatTheSenderHolds) {
  Players players;
  players.read(slicesTo({1, 4}, {0.0, 0.0}), "/mouse", 0.0);
  players.read(slicesTo({2}, {0.0}), "/keys", 0.0);
  HandTargets release;
  release.release = 1U;
  const auto moves = players.read(release, "/mouse", 0.0);
  ASSERT_EQ(moves.size(), 2U);
  EXPECT_EQ(moves[0].slice, 1);
  EXPECT_EQ(moves[1].slice, 4);
  EXPECT_TRUE(moves[0].lets_go && moves[1].lets_go);
  EXPECT_TRUE(players.read(release, "/mouse", 0.0).empty()) << "it holds nothing any more";
  EXPECT_EQ(players.read(release, "/keys", 0.0).size(), 1U);
}

TEST(PlayersTest, OfTwoThatMoveASliceTheLastHasIt) {
  Players players;
  players.read(slicesTo({1}, {0.0}), "/mouse", 0.0);
  players.read(slicesTo({1}, {0.0}), "keyboard", 0.0);
  HandTargets release;
  release.release = 1U;
  EXPECT_TRUE(players.read(release, "/mouse", 0.0).empty());
  EXPECT_EQ(players.read(release, "keyboard", 0.0).size(), 1U);
}

TEST(PlayersTest, WhoHoldsSomethingIsNotForgotten) {
  Players players;
  players.read(slicesTo({1}, {0.0}), "/holds", 0.0);
  HandTargets release;
  release.release = 1U;
  for (int i = 0; i < 100; ++i) {
    players.read(release, "/other" + std::to_string(i), 0.0);
  }
  EXPECT_EQ(players.read(release, "/holds", 0.0).size(), 1U);
}

TEST(PlayersTest, OtherEndEffectorsLetGoOfAll) {
  Players players;
  players.read(slicesTo({1, 4}, {0.0, 0.0}), "/mouse", 0.0);
  const auto moves = players.configure(ballOnSlices({0, 1, 2}));
  ASSERT_EQ(moves.size(), 2U);
  EXPECT_TRUE(moves[0].lets_go && moves[1].lets_go);
  EXPECT_TRUE(players.configure({}).empty());
}

TEST(PlayersTest, SendersHaveNumbersOfTheirOwn) {
  Players players;
  const auto sourceOf = [&](const std::string& sender) {
    return players.read(slicesTo({0}, {0.0}), sender, 0.0)[0].source;
  };
  const auto mouse = sourceOf("/mouse");
  EXPECT_NE(mouse, sourceOf("/keys"));
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(sourceOf("/mouse"), mouse);
    EXPECT_LT(sourceOf("/other" + std::to_string(i)), tgr::kMaxHandSources);
  }
}

TEST(PlayersTest, RefusesWhatIsWrongWithFieldValueAndRange) {
  Players players;
  players.configure(ballOnSlices({0, 1, 2}));
  const auto refusal = [&](const HandTargets& wanted) {
    return complaintOf([&] { players.read(wanted, "/mouse", 0.0); });
  };
  EXPECT_EQ(refusal(slicesTo({64}, {0.0})), "slice is 64, allowed: 0...63");
  EXPECT_EQ(refusal(slicesTo({4294967295U}, {0.0})), "slice is 64, allowed: 0...63");
  EXPECT_EQ(refusal(slicesTo({0}, {0.11})), "target is 0.11, allowed: -0.1...0.1 m");
  EXPECT_EQ(refusal(slicesTo({0}, {std::nan("")})), "target is nan, allowed: -0.1...0.1 m");
  EXPECT_EQ(refusal(slicesTo({0, 1}, {0.0})),
            "the number of targets is 1, allowed: 2, as there are indices");
  EXPECT_EQ(refusal(slicesTo({}, {})), "the number of indices is 0, allowed: 1 or more");
  EXPECT_EQ(refusal(slicesTo(std::vector<std::uint32_t>(65, 0), std::vector<double>(65, 0.0))),
            "the number of indices is 65, allowed: at most 64");
  HandTargets wanted = slicesTo({0}, {0.0});
  wanted.grip = 5;
  EXPECT_EQ(refusal(wanted), "grip is 5, allowed: 0...4");
  wanted = slicesTo({0}, {0.0});
  wanted.timeout = -1.0;
  EXPECT_EQ(refusal(wanted), "timeout is -1, allowed: 0 or more seconds");
  wanted = slicesTo({0}, {0.0});
  wanted.glide = 61.0;
  EXPECT_EQ(refusal(wanted), "glide is 61, allowed: 0...60 s");
  wanted = slicesTo({3}, {0.0});
  wanted.end_effector = "mallet";
  EXPECT_EQ(refusal(wanted), "coordinate of mallet is 3, allowed: 0...2");
  wanted.end_effector = "bow";
  EXPECT_EQ(refusal(wanted), "end_effector is 'bow', allowed: mallet");
}

}  // namespace
}  // namespace ergotic::node
