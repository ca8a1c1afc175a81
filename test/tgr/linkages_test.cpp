// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Dense>

#include "constants.hpp"
#include "support/test.hpp"
#include "tgr/kinematics_cases.hpp"

/// Closed forms, constraints and limits of each kind of end-effector.

namespace ergotic::tgr {
namespace {

using test::Coordinates;
using test::endEffector;
using test::JacobianRows;
using test::KinematicsCase;
using test::RandomPoses;

KinematicsCase caseOf(const std::string& name) {
  for (KinematicsCase& c : test::kinematicsCases()) {
    if (name == c.name) {
      return c;
    }
  }
  throw Exception("no case " + name);
}

struct Moved {
  bool within = false;
  Coordinates x{};
  JacobianRows rows{};
};

Moved move(const EndEffectorConfig& config, const std::vector<double>& q) {
  Moved moved;
  moved.within =
      makeKinematics(config, "hands.yaml")->forward(q.data(), moved.x.data(), moved.rows.data());
  return moved;
}

std::string messageOfLinkage(const EndEffectorConfig& config) {
  return complaintOf<TextError>([&] { makeKinematics(config, "hands.yaml"); });
}

Eigen::Vector3d onCircle(double radius, double degrees) {
  return {radius * std::cos(degrees * kDegree), radius * std::sin(degrees * kDegree), 0.0};
}

double heightOf(double rod, double offset) {
  return std::sqrt(rod * rod - offset * offset);
}

TEST(KeyTest, IsALever) {
  EndEffectorConfig key = endEffector(EndEffectorType::kKey, {0}, {});
  key.lever = 2.5;
  const Moved moved = move(key, {0.01});
  EXPECT_EQ(moved.x[0], 2.5 * 0.01);
  EXPECT_EQ(moved.rows[0], 2.5);
}

TEST(BowTest, TurnsTheAxesOfItsSlices) {
  EndEffectorConfig bow = endEffector(EndEffectorType::kBow, {0, 1}, {});
  bow.lever = 2.0;
  bow.angle = 90.0 * kDegree;  // the first slice presses, the second draws it back
  const Moved moved = move(bow, {0.01, 0.02});
  EXPECT_NEAR(moved.x[0], -0.04, 1e-17);
  EXPECT_NEAR(moved.x[1], 0.02, 1e-17);
}

TEST(StickTest, TiltsAboutItsPivot) {
  EndEffectorConfig stick = endEffector(EndEffectorType::kStick, {0, 1}, {});
  stick.arm = 0.04;
  stick.length = 0.5;
  const Moved moved = move(stick, {0.03, 0.0});  // a triangle of 3, 4 and 5
  EXPECT_DOUBLE_EQ(moved.x[0], 0.3);
  EXPECT_EQ(moved.x[1], 0.0);
  EXPECT_DOUBLE_EQ(moved.rows[0], 0.5 / 0.05 * 0.64);  // length / norm cos^2
  EXPECT_DOUBLE_EQ(moved.rows[3], 0.5 / 0.05);
}

TEST(StickTest, KeepsItsTipOnASphereThatTheThirdSliceWidens) {
  const KinematicsCase c = caseOf("Stick3D");
  RandomPoses poses(c, 6);
  for (int n = 0; n < 1000; ++n) {
    poses.nextWithin();
    const Eigen::Vector3d tip(poses.x()[0], poses.x()[1], poses.x()[2] + c.config.length);
    ASSERT_NEAR(tip.norm(), c.config.length + poses.q()[2], 1e-15);
    ASSERT_NEAR(tip.cross(Eigen::Vector3d(poses.q()[0], poses.q()[1], c.config.arm)).norm(), 0.0,
                1e-16);
  }
}

TEST(StickTest, EndsAt60DegreesAndWhereItWouldSlideIntoItsPivot) {
  EndEffectorConfig stick = endEffector(EndEffectorType::kStick, {0, 1, 2}, {});
  const double edge = stick.arm * std::tan(60.0 * kDegree);
  EXPECT_TRUE(move(stick, {0.999 * edge, 0.0, 0.0}).within);
  EXPECT_FALSE(move(stick, {1.001 * edge, 0.0, 0.0}).within);
  EXPECT_TRUE(move(stick, {0.0, 0.0, -0.749 * stick.length}).within);
  EXPECT_FALSE(move(stick, {0.0, 0.0, -0.751 * stick.length}).within);
}

TEST(BallTest, KeepsTheLengthsOfItsRods) {
  const KinematicsCase c = caseOf("Ball");
  const EndEffectorConfig& ball = c.config;
  const double rest = heightOf(ball.rod, ball.base_radius - ball.platform_radius);
  RandomPoses poses(c, 7);
  for (int n = 0; n < 10000; ++n) {
    poses.nextWithin();
    const Eigen::Vector3d centre(poses.x()[0], poses.x()[1], poses.x()[2] + rest);
    for (int i = 0; i < 3; ++i) {
      const double angle = 90.0 + 120.0 * i;
      Eigen::Vector3d slice = onCircle(ball.base_radius, angle);
      slice.z() = poses.q()[static_cast<std::size_t>(i)];
      const Eigen::Vector3d end = centre + onCircle(ball.platform_radius, angle);
      ASSERT_NEAR((end - slice).norm(), ball.rod, 1e-15) << "rod " << i;
    }
  }
}

TEST(BallTest, EndsBeforeARodLiesFlatOrThePlatformIsLoose) {
  const EndEffectorConfig ball = caseOf("Ball").config;
  const auto kinematics = makeKinematics(ball, "hands.yaml");
  const double rest = heightOf(ball.rod, ball.base_radius - ball.platform_radius);
  const Moved at_rest = move(ball, {0.0, 0.0, 0.0});
  const auto gainOf = [](const JacobianRows& rows) {
    return Eigen::Map<const Eigen::Matrix3d>(rows.data()).norm();
  };
  bool was_within = true;
  for (double q = 0.0; q < 0.2; q += 1e-4) {  // one slice rises under the platform
    const Moved moved = move(ball, {q, 0.0, 0.0});
    EXPECT_TRUE(was_within || !moved.within) << "within again at " << q;
    was_within = moved.within;
    if (moved.within) {
      EXPECT_GE(moved.x[2] + rest - q, 0.2 * ball.rod);
      EXPECT_LE(gainOf(moved.rows), 3.0 * gainOf(at_rest.rows));
    }
  }
  EXPECT_FALSE(was_within);
  EXPECT_TRUE(move(ball, {0.05, 0.0, 0.0}).within);
}

TEST(BallTest, RefusesRodsThatDoNotFit) {
  EndEffectorConfig ball = endEffector(EndEffectorType::kBall, {0, 1, 2}, {});
  ball.rod = 0.05;
  EXPECT_THAT(messageOfLinkage(ball),
              HasSubstr("hands.yaml:4:2: error: end-effector 'ball': rod = 0.05 m "
                        "is too short for these radii, allowed: >= 0.0524"));
  ball.rod = 0.15;
  ball.platform_radius = 0.095;
  EXPECT_THAT(messageOfLinkage(ball), HasSubstr("base_radius - platform_radius = 0.005 m holds no "
                                                "platform sideways, allowed: beyond +-0.0075 m"));
}

/// From the pose alone: slices in pairs 20 degrees wide about 0, 120, 240 degrees, the platform's
/// pairs about 60, 180, 300.
void expectRodsOfTheirLength(const EndEffectorConfig& handle,
                             const test::Pose& q,
                             const Eigen::Isometry3d& pose) {
  constexpr std::array<double, 6> kBase{-10, 10, 110, 130, 230, 250};
  constexpr std::array<double, 6> kPlatform{-50, 50, 70, 170, 190, 290};
  const double offset =
      (onCircle(handle.base_radius, kBase[0]) - onCircle(handle.platform_radius, kPlatform[0]))
          .norm();
  const Eigen::Vector3d rest(0.0, 0.0, heightOf(handle.rod, offset));
  for (std::size_t i = 0; i < 6; ++i) {
    const Eigen::Vector3d slice =
        onCircle(handle.base_radius, kBase[i]) + q[i] * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d end = pose * onCircle(handle.platform_radius, kPlatform[i]) + rest;
    ASSERT_NEAR((end - slice).norm(), handle.rod, 1e-15) << "rod " << i;
  }
}

TEST(HandleTest, KeepsTheLengthsOfItsRodsAndMovesItsPointsRigidly) {
  const KinematicsCase c = caseOf("Handle");
  RandomPoses poses(c, 8);
  for (int n = 0; n < 10000; ++n) {
    poses.nextWithin();
    const Eigen::Isometry3d pose = poses.kinematics().pose(poses.q().data());
    expectRodsOfTheirLength(c.config, poses.q(), pose);
    ASSERT_LT((pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).norm(),
              1e-14);
    const double* x = poses.x().data();
    for (const Eigen::Vector3d& point : c.config.points) {
      ASSERT_LT((pose * point - point - Eigen::Map<const Eigen::Vector3d>(x)).norm(), 1e-15);
      x += 3;
    }
  }
}

/// Follows the rods' constraints in small steps, as a linkage that is moved there would.
TEST(HandleTest, StaysInTheAssemblyThatIsReachedFromRest) {
  RandomPoses poses(caseOf("Handle"), 9);
  const Kinematics& kinematics = poses.kinematics();
  for (int n = 0; n < 500; ++n) {
    poses.nextWithin();
    Coordinates before{};
    for (int step = 0; step <= 200; ++step) {
      test::Pose q{};
      for (std::size_t i = 0; i < 6; ++i) {
        q[i] = poses.q()[i] * step / 200.0;
      }
      Coordinates x{};
      JacobianRows rows{};
      ASSERT_TRUE(kinematics.forward(q.data(), x.data(), rows.data()));
      for (std::size_t k = 0; k < 12; ++k) {
        ASSERT_NEAR(x[k], before[k], 5e-3) << "a jump at step " << step;
      }
      before = x;
    }
  }
}

TEST(HandleTest, EndsBeforeTheRodsCannotHoldIt) {
  const EndEffectorConfig handle = caseOf("Handle").config;
  EXPECT_TRUE(move(handle, {0.03, 0, 0, 0, 0, 0}).within);
  EXPECT_FALSE(move(handle, {0.2, 0, 0, 0, 0, 0}).within);
  EXPECT_FALSE(move(handle, {0.08, -0.08, 0.08, -0.08, 0.08, -0.08}).within);
}

TEST(HandleTest, IsWellConditionedAtRest) {
  const EndEffectorConfig handle = caseOf("Handle").config;
  const Moved moved = move(handle, std::vector<double>(6, 0.0));
  const Eigen::Map<const Eigen::Matrix<double, 12, 6, Eigen::RowMajor>> rows(moved.rows.data());
  const auto gains = rows.jacobiSvd().singularValues();
  EXPECT_LT(gains[0] / gains[5], 5.0);
}

TEST(HandleTest, RefusesPointsThatDoNotFeelEveryMotion) {
  EndEffectorConfig handle = endEffector(EndEffectorType::kHandle, {0, 1, 2, 3, 4, 5}, {});
  EXPECT_THAT(messageOfLinkage(handle), HasSubstr("'handle': 0 points, allowed: 3 to 8"));
  handle.points = {{0, 0, 0}, {0.1, 0, 0}, {0.05, 0.001, 0}};
  EXPECT_THAT(messageOfLinkage(handle), HasSubstr("its points lie within 0.000471"));
  handle.points = {{0, 0, 0}, {0.1, 0, 0}, {0.05, std::nan(""), 0}};
  EXPECT_THAT(messageOfLinkage(handle),
              HasSubstr("points = nan m is out of range, allowed: -1...1 m"));
}

TEST(HandleTest, RefusesRodsThatDoNotFit) {
  EndEffectorConfig handle = caseOf("Handle").config;
  handle.rod = 0.05;
  EXPECT_THAT(messageOfLinkage(handle), HasSubstr("rod = 0.05 m is too short for these radii"));
  handle.rod = 2.0;
  EXPECT_THAT(messageOfLinkage(handle),
              HasSubstr("rod = 2 m on these radii holds no platform sideways"));
}

}  // namespace
}  // namespace ergotic::tgr
