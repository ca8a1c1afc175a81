// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using Eigen::Vector3d;

/// Scenes whose audio section has this geometry.
struct Built : SceneBuilder {
  explicit Built(Geometry geometry) { scene.sections[0].geometry = geometry; }
  int massAt(double kg, const Vector3d& x, const Vector3d& v = Vector3d::Zero()) {
    const int m = mass(kg);
    scene.mats[at(m)].position = x;
    scene.mats[at(m)].push.edit().velocity = v;
    return m;
  }
};

Vector3d heardVector(const Player& player, int first_channel, std::size_t n) {
  return {player.heard[at(first_channel)][n], player.heard[at(first_channel + 1)][n],
          player.heard[at(first_channel + 2)][n]};
}

/// Two masses and a wall in a row, held apart by springs, hit by a contact.
std::vector<std::vector<double>> playRow(Geometry geometry) {
  Built b(geometry);
  const int wall = b.ground();
  const int low = b.mass(1e-3, 1.0, 3.0);
  const int high = b.mass(2e-3, 2.1);
  const int top = b.mass(1e-3, 2.5, -8.0);
  for (int i = 0; i < 4; ++i) {
    b.scene.mats[at(i)].rest.x() = 0.9 * i;  // stored from elsewhere than they start
  }
  for (const auto& [upper, lower] : {std::pair(low, wall), {high, low}}) {
    const int l = b.spring(upper, lower, 3e3, 0.2);
    b.scene.lias[at(l)].rest_length = 0.8;
  }
  const int l = b.link(LiaType::kCubic, top, high, 500.0, 0.1);
  b.scene.lias[at(l)].law.edit().nonlinearity = {1e4};
  b.scene.lias[at(l)].rest_length = 0.4;
  b.link(LiaType::kContact, high, top, 4e3, 0.1);
  b.scene.lias.back().law.edit().width = {0.35};
  b.hear(low, 0);
  b.hear(high, 1);
  b.hear(top, 2);
  Player player(b.scene, {kRate, 10});
  player.ticks(400);
  return player.heard;
}

TEST(GeometryTest, LineIsScalarWhileNothingPasses) {
  const auto scalar = playRow(Geometry::kScalar);
  const auto line = playRow(Geometry::kLine);
  double closest = 1.0;
  for (std::size_t n = 0; n < scalar[0].size(); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(scalar[c][n], line[c][n], 1e-12) << n;
    }
    closest = std::min(closest, line[2][n] - line[1][n]);
  }
  EXPECT_LT(closest, 0.35) << "the contact acted";
  EXPECT_GT(closest, 0.0);
}

TEST(GeometryTest, LineHoldsModulesThatPassedOnTheOtherSide) {
  // The distance is the same on either side: at rest from the start.
  Built b(Geometry::kLine);
  const int mass = b.mass(1e-3, -0.5);
  const int l = b.spring(mass, b.ground(), 1e3);
  b.scene.lias[at(l)].rest_length = 0.5;
  b.hear(mass);
  Player player(b.scene, {kRate, 10});
  player.ticks(100);
  EXPECT_EQ(player.heard[0].back(), -0.5);
}

TEST(GeometryTest, SpringWithoutRestLengthIsHarmonicAlongEveryAxis) {
  for (const Geometry geometry : {Geometry::kPlane, Geometry::kSpace}) {
    Built b(geometry);
    const Vector3d start(0.1, -0.2, geometry == Geometry::kSpace ? 0.3 : 0.0);
    const Vector3d velocity(50.0, 20.0, geometry == Geometry::kSpace ? -30.0 : 0.0);
    const double kappa = 0.02;
    const int mass = b.massAt(1e-3, start, velocity);
    b.spring(mass, b.ground(), kappa * 1e-3 * kRate * kRate);
    b.hearAxes(mass, 0);
    Player player(b.scene, {kRate, 10});
    player.ticks(500);
    // x[n] through x[0] = x + d and x[1] = x[0] (1 - kappa) + d.
    const double w = 2.0 * std::asin(std::sqrt(kappa) / 2.0);
    for (int axis = 0; axis < dimensionsOf(geometry); ++axis) {
      const double d = velocity[axis] * kStep;
      const double first = start[axis] + d;
      const double second = first * (1.0 - kappa) + d;
      const double other = (second - first * std::cos(w)) / std::sin(w);
      for (int n = 0; n < 5000; n += 11) {
        ASSERT_NEAR(player.heard[at(axis)][at(n)],
                    first * std::cos(w * n) + other * std::sin(w * n), 1e-12);
      }
    }
  }
}

TEST(GeometryTest, TwoBodiesOrbitAtTheDistanceWhereTheSpringTurnsThem) {
  // A step turns the relative position by an angle with 2 - 2 cos = kappa (1 - rest/distance).
  const double kappa = 0.01;
  const double distance = 1.25;
  const double turn = 2.0 * std::asin(0.5 * std::sqrt(kappa * (1.0 - 1.0 / distance)));
  Built b(Geometry::kPlane);
  const Vector3d now(distance, 0.0, 0.0);
  const Vector3d before(distance * std::cos(turn), -distance * std::sin(turn), 0.0);
  const Vector3d velocity = (now - before) * kRate;
  const double share = 0.25;  // of the lighter mass in both
  b.massAt(1e-3, (1.0 - share) * before, (1.0 - share) * velocity);
  b.massAt(3e-3, -share * before, -share * velocity);
  const double reduced = 1e-3 * 3e-3 / 4e-3;
  b.scene.lias[at(b.spring(0, 1, kappa * reduced * kRate * kRate))].rest_length = 1.0;
  b.hearAxes(0, 0);
  b.hearAxes(1, 2);
  Player player(b.scene, {kRate, 10});
  player.ticks(2000);
  for (int n = 0; n < 20000; n += 17) {
    ASSERT_NEAR(player.heard[0][at(n)] - player.heard[2][at(n)], distance * std::cos(turn * n),
                1e-9);
    ASSERT_NEAR(player.heard[1][at(n)] - player.heard[3][at(n)], distance * std::sin(turn * n),
                1e-9);
    ASSERT_NEAR(player.heard[0][at(n)] * share, -player.heard[2][at(n)] * (1.0 - share), 1e-12);
  }
}

TEST(GeometryTest, PendulumSwingsByItsLengthAndGravity) {
  Built b(Geometry::kPlane);
  const double g = 9.81;
  const double m = 0.01;
  const double k = 1e5;
  b.scene.sections[0].gravity.y() = -g;
  const double length = 0.02 + m * g / k;  // under its own weight
  // Gravity acts in the first step already, the spring from the second on.
  const int bob = b.massAt(m, {1e-7, -length, 0.0}, {0.0, g * kStep, 0.0});
  b.scene.lias[at(b.spring(bob, b.ground(), k))].rest_length = 0.02;
  b.hear(bob);
  Player player(b.scene, {kRate, 10});
  player.ticks(3000);
  const double expected = 2.0 * std::asin(0.5 * std::sqrt(g / length) * kStep);
  std::vector<double> sometimes;  // the slow angle of a single sample would drown in rounding
  for (std::size_t n = 0; n < player.heard[0].size(); n += 1000) {
    sometimes.push_back(player.heard[0][n]);
  }
  EXPECT_NEAR(std::arg(test::poleOf(sometimes)) / (1000.0 * expected), 1.0, 1e-6);
}

/// A free net of springs, nonlinear springs and dampers, not at rest.
struct Net {
  std::vector<Vector3d> positions;
  std::vector<Vector3d> velocities;

  explicit Net(int masses) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> spread(-1.0, 1.0);
    for (int i = 0; i < masses; ++i) {
      positions.emplace_back(spread(random), spread(random), spread(random));
      velocities.emplace_back(spread(random), spread(random), spread(random));
    }
  }
  Built build(const Eigen::Matrix3d& turned) const {
    Built b(Geometry::kSpace);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const int m = b.massAt(1e-3 * (1.0 + static_cast<double>(i)), turned * positions[i],
                             turned * velocities[i]);
      b.scene.mats[at(m)].rest = turned * (positions[i] + Vector3d(0.1, 0.2, 0.3));
      b.hearAxes(m, 6 * m);
      b.hearAxes(m, 6 * m + 3, Quantity::kVelocity);
    }
    const LiaType types[] = {LiaType::kSpringDamper, LiaType::kCubic, LiaType::kContact,
                             LiaType::kQuadratic, LiaType::kPowerContact};
    int next = 0;
    for (int i = 0; i < static_cast<int>(positions.size()); ++i) {
      for (int j = 0; j < i; ++j) {
        const int l = b.link(types[next++ % 5], i, j, 500.0, 0.01);
        scene::Lia& lia = b.scene.lias[at(l)];
        const bool gap = lia.type == LiaType::kContact || lia.type == LiaType::kPowerContact;
        lia.law.edit().nonlinearity = {100.0};
        lia.law.edit().exponent = {1.5};
        lia.law.edit().width = {gap ? 0.9 : 0.0};
        lia.rest_length = gap ? 0.0 : 0.7;
        lia.scheme = scene::Scheme::kExplicit;
      }
    }
    return b;
  }
};

TEST(GeometryTest, TurnedNetMovesTurned) {
  const Net net(6);
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(1.1, Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  Player straight(net.build(Eigen::Matrix3d::Identity()).scene, {kRate, 10});
  Player player(net.build(turned).scene, {kRate, 10});
  straight.ticks(100);
  player.ticks(100);
  double moved = 0.0;
  for (int m = 0; m < 6; ++m) {
    for (std::size_t n = 0; n < 1000; n += 3) {
      const Vector3d expected = turned * heardVector(straight, 6 * m, n);
      ASSERT_LT((heardVector(player, 6 * m, n) - expected).norm(), 1e-12) << m << ", " << n;
    }
    moved += (heardVector(player, 6 * m, 999) - heardVector(player, 6 * m, 0)).norm();
  }
  EXPECT_GT(moved, 0.1);
}

TEST(GeometryTest, FreeNetKeepsItsMomentumAndAngularMomentum) {
  Player player(Net(6).build(Eigen::Matrix3d::Identity()).scene, {kRate, 10});
  player.ticks(500);
  const auto momenta = [&](std::size_t n) {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (int m = 0; m < 6; ++m) {
      const Vector3d p = 1e-3 * (1.0 + m) * heardVector(player, 6 * m + 3, n);
      sum.head<3>() += p;
      sum.tail<3>() += heardVector(player, 6 * m, n).cross(p);
    }
    return sum;
  };
  const auto start = momenta(0);
  EXPECT_GT(start.tail<3>().norm(), 1e-3);
  for (std::size_t n = 0; n < 5000; n += 37) {
    ASSERT_LT((momenta(n) - start).norm(), 1e-13) << n;
  }
}

}  // namespace
}  // namespace ergotic::physics
