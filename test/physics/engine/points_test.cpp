// SPDX-License-Identifier: BSD-3-Clause
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

struct PointScene : SceneBuilder {
  /// Fixed modules in a row at x = 0, 1, 2...: a point among them is heard where it lies.
  int ruler(int count) {
    const int first = ground(0.0);
    for (int i = 1; i < count; ++i) {
      ground(i);
    }
    return grid(first, count);
  }
  void parameter(double value, double lowest, double highest) {
    scene.parameters.push_back({"place", value, lowest, highest, {}});
  }
};

TEST(PointTest, ForceIsHandedOnWithTheWeightsOfThePosition) {
  PointScene b;
  const int on = b.ruler(11);
  const int point = b.point(on, 0.34);
  b.spring(b.driven(0), point, 100.0);
  for (int i = 0; i < 11; ++i) {
    b.hear(i, i, Quantity::kForce);
  }
  Player player(b.scene, {kRate, 1});
  player.inputs = {5.0};
  player.tick();
  double sum = 0.0;
  double moment = 0.0;
  for (int i = 0; i < 11; ++i) {
    sum += player.heard[at(i)].back();
    moment += i * player.heard[at(i)].back();
  }
  const double force = 100.0 * (5.0 - 3.4);
  EXPECT_NEAR(sum, force, 1e-10);
  EXPECT_NEAR(moment, 3.4 * force, 1e-10);
  EXPECT_NEAR(player.heard[3].back(), 0.6 * force, 1e-10);
  EXPECT_NEAR(player.heard[4].back(), 0.4 * force, 1e-10);
}

TEST(PointTest, MeshSharesTheForceOutOverFourModules) {
  PointScene b;
  const int columns = 4;
  const int rows = 3;
  for (int i = 0; i < columns * rows; ++i) {
    b.ground();
    b.hear(i, i, Quantity::kForce);
  }
  const int on = b.grid(0, columns, rows);
  b.spring(b.driven(0), b.point(on, 0.45, 0.8), 100.0);
  Player player(b.scene, {kRate, 1});
  player.inputs = {0.1};
  player.tick();
  double sum = 0.0;
  double column = 0.0;
  double row = 0.0;
  int touched = 0;
  for (int i = 0; i < columns * rows; ++i) {
    const double force = player.heard[at(i)].back();
    sum += force;
    column += force * (i % columns);
    row += force * (i / columns);
    touched += force != 0.0 ? 1 : 0;
  }
  EXPECT_EQ(touched, 4);
  EXPECT_NEAR(sum, 10.0, 1e-12);
  EXPECT_NEAR(column, 10.0 * 0.45 * (columns - 1), 1e-12);
  EXPECT_NEAR(row, 10.0 * 0.8 * (rows - 1), 1e-12);
}

TEST(PointTest, OnAModuleIsThatModule) {
  const auto play = [](bool by_point) {
    PointScene b;
    const int first = b.chain(15, 1e-3, 2e3, 0.01);
    const int hammer = b.mass(2e-3, -1e-3, 2.0);
    const int there = by_point ? b.point(b.grid(first, 17), 0.25) : first + 4;
    b.link(LiaType::kContact, hammer, there, 5e3, 0.1);
    b.spring(there, b.cell(1e-3, 500.0, 0.1), 200.0, 0.05);
    b.hear(first + 9);
    Player player(b.scene, {kRate, 14});
    player.ticks(300);
    return player.heard[0];
  };
  const auto by_module = play(false);
  const auto by_point = play(true);
  EXPECT_GT(std::abs(by_module.back()), 1e-6);
  for (std::size_t n = 0; n < by_module.size(); ++n) {
    ASSERT_NEAR(by_point[n], by_module[n], 1e-14) << n;
  }
}

TEST(PointTest, PlaceThatFollowsAParameterMovesAtItsSpeed) {
  for (const auto& [from, to] : {std::pair(0.2, 0.8), {0.8, 0.2}}) {
    PointScene b;
    const int on = b.ruler(11);
    const int point = b.point(on, 1.0);
    b.parameter(from, 0.0, 1.0);
    b.scene.connections[0].along.at = {1.0, 0};
    const double speed = 300.0;  // places per second
    b.scene.connections[0].speed = speed;
    b.hear(point, 0);
    b.hear(point, 1, Quantity::kVelocity);
    Player player(b.scene, {kRate, 10});
    player.tick();
    EXPECT_NEAR(player.heard[0].back(), 10.0 * from, 1e-12);
    player.instrument->exchange(player.instrument->prepare({to}));
    player.ticks(20);
    double place = from;
    for (int n = 0; n < 200; ++n) {
      const double way = (to - place) / (10 - n % 10);  // there with the last frame
      place += std::clamp(way, -speed / kRate, speed / kRate);
      ASSERT_NEAR(player.heard[0][at(10 + n)], 10.0 * place, 1e-10) << n;
      ASSERT_EQ(player.heard[1][at(10 + n)], 0.0) << "the string itself is at rest";
    }
    EXPECT_NEAR(place, to, 1e-12);
  }
}

TEST(PointTest, PlaceWithoutASpeedIsThereWithinATick) {
  PointScene b;
  const int point = b.point(b.ruler(11), 1.0);
  b.parameter(0.2, 0.0, 1.0);
  b.scene.connections[0].along.at = {1.0, 0};
  b.hear(point);
  Player player(b.scene, {kRate, 1});
  player.tick();
  player.instrument->exchange(player.instrument->prepare({0.8}));
  player.tick();
  EXPECT_NEAR(player.heard[0].back(), 8.0, 1e-12);
}

TEST(PointTest, SpeedIsPerSecondInSlowerSectionsToo) {
  PointScene b;
  b.scene.sections[0].divisor = 5;
  const int point = b.point(b.ruler(11), 1.0);
  b.parameter(0.2, 0.0, 1.0);
  b.scene.connections[0].along.at = {1.0, 0};
  b.scene.connections[0].speed = 300.0;
  b.hear(point);
  Player player(b.scene, {kRate, 10});
  player.tick();
  player.instrument->exchange(player.instrument->prepare({0.8}));
  player.ticks(3);
  for (int n = 0; n < 30; ++n) {
    const int steps = n / 5 + 1;
    EXPECT_NEAR(player.heard[0][at(10 + n)], 2.0 + 3000.0 * steps * 5.0 / kRate, 1e-10) << n;
  }
}

TEST(PointTest, GuideLeadsAlongTheStringWithinItsRange) {
  PointScene b;
  const int point = b.point(b.ruler(11), 0.4);
  scene::Connection& connection = b.scene.connections[0];
  connection.along.guide = b.slice(0);
  connection.along.scale = 20.0;
  connection.along.minimum = 0.1;
  connection.along.maximum = 0.7;
  b.hear(point);
  Player player(b.scene, {kRate, 2});
  for (const double hand : {0.0, 0.01, -0.01, 0.014, 0.1, -0.1}) {
    player.positions[0] = hand;
    player.tick();
    EXPECT_NEAR(player.heard[0].back(), 10.0 * std::clamp(0.4 + 20.0 * hand, 0.1, 0.7), 1e-12);
  }
}

TEST(PointTest, LinkBetweenTwoMovingPlacesKeepsMomentumAndEnergyBalances) {
  PointScene b;
  std::vector<int> points;
  for (int s = 0; s < 2; ++s) {
    const int first = b.mass(1e-3, 0.0, s == 0 ? 1.0 : -1.0);
    for (int i = 1; i < 12; ++i) {
      const int m = b.mass(1e-3, 1e-3 * i * s);
      b.spring(m - 1, m, 1e3);
    }
    points.push_back(b.point(b.grid(first, 12), 0.0));
    scene::Connection& connection = b.scene.connections[at(s)];
    connection.along.at = {s == 0 ? 1.0 : 0.5, 0};
    connection.speed = 40.0;
  }
  b.parameter(0.1, 0.0, 1.0);
  b.link(LiaType::kCubic, points[0], points[1], 800.0, 0.02);
  b.scene.lias.back().law.edit().nonlinearity = {1e5};
  for (int m = 0; m < 25; ++m) {
    if (b.scene.mats[at(m)].type == scene::MatType::kMass) {
      b.hear(m, 0, Quantity::kVelocity);
    }
  }
  Player player(b.scene, {kRate, 14});
  for (int n = 0; n < 400; ++n) {
    if (n % 40 == 1) {
      player.instrument->exchange(player.instrument->prepare({n % 80 == 1 ? 0.93 : 0.08}));
    }
    player.tick();
    const Energies energies = energiesOf(player);
    ASSERT_NEAR(player.heard[0].back(), 0.0, 1e-12) << "sum of all velocities";
    ASSERT_LT(std::abs(energies.residual), 1e-11 * energies.stored) << n;
  }
  EXPECT_GT(std::abs(energiesOf(player).sections[0].from_inputs), 1e-6)
      << "moving a place takes work";
}

TEST(PointTest, GlidingUpASlopeTakesTheWorkThatTheSpringStores) {
  for (const double cubic : {0.0, 3.0}) {
    PointScene b;
    const int point = b.point(b.ruler(11), 1.0);  // a slope of fixed modules: 0...10 m
    b.parameter(0.2, 0.0, 1.0);
    b.scene.connections[0].along.at = {1.0, 0};
    b.scene.connections[0].speed = 30.0;
    b.scene.connections[0].power = 1e9;
    b.link(cubic > 0.0 ? LiaType::kCubic : LiaType::kSpringDamper, point, b.ground(), 100.0);
    b.scene.lias[0].law.edit().nonlinearity = {cubic};
    Player player(b.scene, {kRate, 10});
    player.tick();
    player.instrument->exchange(player.instrument->prepare({0.8}));
    player.ticks(100);
    const Energies energies = energiesOf(player);
    const auto stored = [&](double x) { return 50.0 * x * x + 0.25 * cubic * std::pow(x, 4.0); };
    EXPECT_NEAR(energies.sections[0].from_inputs / (stored(8.0) - stored(2.0)), 1.0, 1e-6);
    EXPECT_NEAR(energies.stored / stored(8.0), 1.0, 1e-6);
    EXPECT_LT(std::abs(energies.residual), 1e-12 * energies.stored);
  }
}

TEST(PointTest, StringFrettedInTheMiddleSoundsAnOctaveHigher) {
  const double kappa = 0.05;
  const double m = 1e-4;
  const auto play = [&](double fret) {
    PointScene b;
    const int first = b.chain(79, m, kappa * m * kRate * kRate);
    for (int i = 1; i < 40; ++i) {
      b.scene.mats[at(first + i)].position.x() = 1e-3 * (i < 11 ? i / 11.0 : (40 - i) / 29.0);
    }
    b.spring(b.point(b.grid(first, 81), 0.5), b.ground(), fret * m * kRate * kRate);
    b.hear(first + 17);
    Player player(b.scene, {kRate, 14});
    player.ticks(1600);
    return player.heard[0];
  };
  const double open_hz = std::asin(std::sqrt(kappa) * std::sin(M_PI / 160.0)) / M_PI * kRate;
  const double octave_hz = std::asin(std::sqrt(kappa) * std::sin(M_PI / 80.0)) / M_PI * kRate;
  EXPECT_LT(std::abs(test::cents(test::partialNear(play(0.0), open_hz, kRate), open_hz)), 0.01);
  // The fret gives way a little: by 1/1200 of the string.
  const double played = test::cents(test::partialNear(play(3.0), octave_hz, kRate), octave_hz);
  EXPECT_LT(played, 0.0);
  EXPECT_GT(played, -2.0);
}

}  // namespace
}  // namespace ergotic::physics
