// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::LiaType;
using test::Player;
using test::SceneBuilder;

constexpr Rates kRates{44100.0, 14};

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

scene::Lia& guard(SceneBuilder& b, LiaType type, int from, int to, double k, double z = 0.0) {
  scene::Lia& lia = b.scene.lias[at(b.link(type, from, to, k, z))];
  lia.scheme = scene::Scheme::kGuarded;
  lia.law.edit().nonlinearity = {1e4};
  lia.law.edit().stiffness_limit = {2.0 * k};
  lia.law.edit().tipping_point = std::sqrt(k / 1e4);
  lia.law.edit().exponent = {1.5};
  const bool is_bow = type == LiaType::kBow || type == LiaType::kSmoothBow;
  lia.law.edit().width = {is_bow ? 0.1 : 0.0};
  if (type == LiaType::kTable) {
    lia.law.edit().table = {{{-1.0, -2.0 * k}, {0.0, 0.0}, {1.0, k}}, true};
    lia.law.edit().viscous_table = {{{-1.0, -0.2}, {0.0, 0.0}, {1.0, 0.1}}, false};
  }
  return lia;
}

TEST(GuardedInstrumentTest, BallLeavesAGuardedWallAsFastAsItCame) {
  SceneBuilder b;
  const int ball = b.mass(5e-3, -1e-3, 1.0);
  guard(b, LiaType::kPowerContact, ball, b.ground(), 1e7);
  b.hear(ball, 0, scene::Quantity::kVelocity);
  Player player(b.scene, kRates);
  player.ticks(20);
  EXPECT_NEAR(player.heard[0].back(), -1.0, 1e-12);
  std::vector<GuardReport> reports = player.instrument->makeGuardReports();
  player.instrument->readGuards(reports);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports[0].lia, 0);
  EXPECT_GT(reports[0].active, 3);
  EXPECT_LE(reports[0].clipped, reports[0].active);
}

/// Largest residual of the balance over what was ever stored.
double imbalance(Player& player, int ticks) {
  Energies e = player.instrument->makeEnergies();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  double residual = 0.0;
  double stored = 0.0;
  for (int n = 0; n < ticks; ++n) {
    for (double& x : player.positions) {
      x += 1e-4 * noise(random);
    }
    player.tick();
    player.instrument->readEnergies(e);
    residual = std::max(residual, std::abs(e.residual));
    stored = std::max(stored, std::abs(e.stored));
  }
  return residual / stored;
}

constexpr LiaType kGuardable[] = {
    LiaType::kSpringDamper, LiaType::kContact,      LiaType::kQuadratic,    LiaType::kCubic,
    LiaType::kClippedCubic, LiaType::kCubicContact, LiaType::kPowerContact, LiaType::kTable,
    LiaType::kBow,          LiaType::kSmoothBow,    LiaType::kFelt};

TEST(GuardedInstrumentTest, EveryLawBalancesInEveryGeometryAndAcrossRates) {
  for (const LiaType type : kGuardable) {
    for (const Geometry geometry : {Geometry::kScalar, Geometry::kPlane, Geometry::kSpace}) {
      SceneBuilder b;
      b.scene.sections[0].geometry = geometry;
      const int first = b.chain(12, 1e-3, 1000.0, 0.01);
      b.scene.mats[at(first + 7)].position.x() = 1e-3;
      const int hand = b.slice(0);
      const int slow = b.mass(0.1, 0.0, 0.3, SceneBuilder::kGestural);
      b.spring(slow, b.ground(0.0, SceneBuilder::kGestural), 500.0, 0.2);
      guard(b, type, hand, first + 5, 200.0, 0.1);
      guard(b, type, slow, first + 9, 200.0, 0.1);
      guard(b, type, first + 3, first + 6, 200.0, 0.1);
      guard(b, type, first + 5, first + 6, 200.0);
      Player player(b.scene, kRates);
      EXPECT_LT(imbalance(player, 2000), 1e-10)
          << static_cast<int>(type) << " " << static_cast<int>(geometry);
    }
  }
}

/// A string with a place on it that a guide moves.
int movingPlace(SceneBuilder& b, int first, int columns, int guide) {
  scene::Mat point;
  point.name = "place";
  point.type = scene::MatType::kPoint;
  b.scene.mats.push_back(point);
  scene::Grid grid;
  grid.name = "string";
  grid.first = first;
  grid.columns = columns;
  b.scene.grids.push_back(grid);
  scene::Connection connection;
  connection.mat = static_cast<int>(b.scene.mats.size()) - 1;
  connection.along = {0.4};
  connection.guide = guide;
  connection.guide_scale = 200.0;
  b.scene.connections.push_back(connection);
  return connection.mat;
}

TEST(GuardedInstrumentTest, LinkOnAMovingPlaceBalances) {
  for (const LiaType type : {LiaType::kContact, LiaType::kCubic, LiaType::kSmoothBow}) {
    SceneBuilder b;
    const int first = b.chain(12, 1e-3, 1000.0, 0.01);
    b.scene.mats[at(first + 7)].position.x() = 1e-3;
    const int hand = b.slice(0);
    const int place = movingPlace(b, first, 14, hand);
    const int anvil = b.mass(0.02, 0.0, 0.1);
    b.spring(anvil, b.ground(), 100.0);
    guard(b, type, anvil, place, 5000.0, 0.2);
    guard(b, type, place, first + 3, 300.0);
    Player player(b.scene, kRates);
    EXPECT_LT(imbalance(player, 2000), 1e-10) << static_cast<int>(type);
  }
}

TEST(GuardedInstrumentTest, PlaceWeighsAsItsModulesDo) {
  // Two masses that move alike, hit in their middle: as one of twice the mass.
  SceneBuilder pair;
  const int first = pair.mass(2.5e-3, -1e-3, 1.0);
  pair.mass(2.5e-3, -1e-3, 1.0);
  const int place = movingPlace(pair, first, 2, -1);
  pair.scene.connections[0].along = {0.5};
  guard(pair, LiaType::kContact, place, pair.ground(), 2e5);
  pair.hear(first);
  Player two(pair.scene, kRates);
  SceneBuilder single;
  const int ball = single.mass(5e-3, -1e-3, 1.0);
  guard(single, LiaType::kContact, ball, single.ground(), 2e5);
  single.hear(ball);
  Player one(single.scene, kRates);
  two.ticks(20);
  one.ticks(20);
  for (std::size_t n = 0; n < one.heard[0].size(); ++n) {
    ASSERT_NEAR(two.heard[0][n], one.heard[0][n], 1e-14) << n;
  }
}

TEST(GuardedInstrumentTest, TurningAKnobIsWorkOfTheKnob) {
  SceneBuilder b;
  b.scene.parameters.push_back({"k", 1.0, 0.5, 4.0, {}});
  const int mass = b.mass(1e-2, 1e-2);
  scene::Lia& lia = guard(b, LiaType::kCubic, mass, b.ground(), 300.0);
  lia.stiffness = {300.0, 0};
  Player player(b.scene, kRates);
  player.ticks(10);
  Energies e = player.instrument->makeEnergies();
  for (const double k : {4.0, 0.5, 1.0}) {
    player.instrument->exchange(player.instrument->prepare({k}));
    player.ticks(37);
    player.instrument->readEnergies(e);
    EXPECT_LT(std::abs(e.residual), 1e-10 * e.stored) << k;
  }
  EXPECT_NE(e.from_parameters, 0.0);
  EXPECT_LT(std::abs(e.sections[0].dissipated), 0.2 * e.stored);
}

TEST(GuardedInstrumentTest, SavedStateGoesOnAsIfNothingHadHappened) {
  SceneBuilder b;
  const int first = b.chain(12, 1e-3, 1000.0, 0.01);
  guard(b, LiaType::kCubic, first + 3, first + 4, 2000.0);
  guard(b, LiaType::kPowerContact, first + 4, b.ground(), 1e7);
  b.scene.mats[at(first + 4)].position.x() = -1e-3;
  b.hear(first + 4);
  Player player(b.scene, kRates);
  player.ticks(5);
  std::vector<char> state(player.instrument->stateSize());
  player.instrument->saveState(state.data());
  player.heard[0].clear();
  player.ticks(50);
  const std::vector<double> once = player.heard[0];
  player.instrument->loadState(state.data());
  player.heard[0].clear();
  player.ticks(50);
  EXPECT_EQ(player.heard[0], once);
}

TEST(GuardedInstrumentTest, SinglePrecisionPlaysTheSame) {
  SceneBuilder b;
  const int ball = b.mass(5e-3, -1e-3, 1.0);
  guard(b, LiaType::kPowerContact, ball, b.ground(), 1e7);
  b.hear(ball, 0, scene::Quantity::kVelocity);
  Player player(b.scene, kRates, Precision::kFloat);
  player.ticks(20);
  EXPECT_NEAR(player.heard[0].back(), -1.0, 1e-5);
}

}  // namespace
}  // namespace ergotic::physics
