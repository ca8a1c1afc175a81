// SPDX-License-Identifier: BSD-3-Clause
#include "support/realtime_scope.hpp"
#include "support/test.hpp"
#include "tgr/kinematics_cases.hpp"

/// What holds for every kind of end-effector.

namespace ergotic::tgr {
namespace {

using test::Coordinates;
using test::JacobianRows;
using test::KinematicsCase;
using test::Pose;
using test::RandomPoses;

class KinematicsTest : public ::testing::TestWithParam<KinematicsCase> {};

TEST_P(KinematicsTest, RestsAtZeroWithAllSlicesAtRest) {
  const auto kinematics = makeKinematics(GetParam().config, "hands.yaml");
  const Pose q{};
  Coordinates x{};
  JacobianRows rows{};
  ASSERT_TRUE(kinematics->forward(q.data(), x.data(), rows.data()));
  for (const double coordinate : x) {
    EXPECT_NEAR(coordinate, 0.0, 1e-16);
  }
  EXPECT_TRUE(kinematics->pose(q.data()).isApprox(Eigen::Isometry3d::Identity(), 1e-15));
}

TEST_P(KinematicsTest, HasTheJacobianOfItsForwardMap) {
  constexpr double kStep = 5e-5;  // fourth-order differences: errors of truncation and of rounding
  KinematicsCase inner = GetParam();
  inner.stroke *= 0.6;  // at the edge the map bends too much for differences
  RandomPoses poses(inner, 2);
  const Kinematics& kinematics = poses.kinematics();
  JacobianRows unused{};
  for (int n = 0; n < 2000; ++n) {
    poses.nextWithin();
    for (int i = 0; i < kinematics.slices(); ++i) {
      const auto at = [&](double step) {
        Pose q = poses.q();
        q[static_cast<std::size_t>(i)] += step;
        Coordinates x{};
        EXPECT_TRUE(kinematics.forward(q.data(), x.data(), unused.data()));
        return x;
      };
      const Coordinates x[4] = {at(-2.0 * kStep), at(-kStep), at(kStep), at(2.0 * kStep)};
      for (int c = 0; c < kinematics.coordinates(); ++c) {
        const auto k = static_cast<std::size_t>(c);
        const double slope = (8.0 * (x[2][k] - x[1][k]) - (x[3][k] - x[0][k])) / (12.0 * kStep);
        ASSERT_NEAR(poses.jacobian(c, i), slope, 1e-11) << "coordinate " << c << ", slice " << i;
      }
    }
  }
}

/// The slices that bring it somewhere are those that are there, as each pose within has a map that
/// can be inverted; from rest on, whatever the way.
TEST_P(KinematicsTest, IsBroughtToWhereItCanBe) {
  constexpr double kMax = 0.1;
  RandomPoses poses(GetParam(), 3);
  const Kinematics& kinematics = poses.kinematics();
  JacobianRows unused{};
  for (int n = 0; n < 500; ++n) {
    poses.nextWithin();
    Pose q{};
    EXPECT_LT(bringTo(kinematics, poses.x().data(), kMax, q.data()), 1e-9) << n;
    Coordinates x{};
    ASSERT_TRUE(kinematics.forward(q.data(), x.data(), unused.data()));
    for (int c = 0; c < kinematics.coordinates(); ++c) {
      const auto k = static_cast<std::size_t>(c);
      EXPECT_NEAR(x[k], poses.x()[k], 1e-9);
    }
  }
}

TEST_P(KinematicsTest, IsBroughtAsNearAsItGetsToWhereItCannotBe) {
  constexpr double kMax = 0.02;
  const auto kinematics = makeKinematics(GetParam().config, "hands.yaml");
  Coordinates x{};
  x.fill(1.0);
  Pose q{};
  EXPECT_GT(bringTo(*kinematics, x.data(), kMax, q.data()), 0.5);
  Coordinates reached{};
  JacobianRows unused{};
  EXPECT_TRUE(kinematics->forward(q.data(), reached.data(), unused.data())) << "within";
  for (const double slice : q) {
    EXPECT_LE(std::abs(slice), kMax);
  }
}

TEST_P(KinematicsTest, DoesNotRememberWhereItWas) {
  RandomPoses poses(GetParam(), 3);
  RandomPoses others(GetParam(), 4);
  for (int n = 0; n < 1000; ++n) {
    poses.nextWithin();
    others.next();
    Coordinates x{};
    JacobianRows rows{};
    ASSERT_TRUE(poses.kinematics().forward(poses.q().data(), x.data(), rows.data()));
    others.kinematics().forward(others.q().data(), x.data(), rows.data());
    ASSERT_TRUE(others.kinematics().forward(poses.q().data(), x.data(), rows.data()));
    ASSERT_EQ(std::vector<double>(x.begin(), x.begin() + poses.kinematics().coordinates()),
              std::vector<double>(poses.x().begin(),
                                  poses.x().begin() + poses.kinematics().coordinates()));
  }
}

TEST_P(KinematicsTest, RefusesWhatIsNoNumberAndWritesNothing) {
  const auto kinematics = makeKinematics(GetParam().config, "hands.yaml");
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (int i = 0; i < kinematics->slices(); ++i) {
      Pose q{};
      q[static_cast<std::size_t>(i)] = bad;
      Coordinates x{};
      JacobianRows rows{};
      EXPECT_FALSE(kinematics->forward(q.data(), x.data(), rows.data())) << bad << " at " << i;
      EXPECT_EQ(x, Coordinates{});
      EXPECT_EQ(rows, JacobianRows{});
    }
  }
}

TEST_P(KinematicsTest, IsRealtime) {
  RandomPoses poses(GetParam(), 5);
  double sum = 0.0;
  test::expectRealtime([&] {
    for (int n = 0; n < 1000; ++n) {
      poses.nextWithin();
      sum += poses.kinematics().pose(poses.q().data()).translation().x();
    }
  });
  EXPECT_TRUE(std::isfinite(sum));
}

INSTANTIATE_TEST_SUITE_P(All,
                         KinematicsTest,
                         ::testing::ValuesIn(test::kinematicsCases()),
                         [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace ergotic::tgr
