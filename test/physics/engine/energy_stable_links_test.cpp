// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include "physics/engine/reference/bow_periods.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

scene::Lia& energyStable(
    SceneBuilder& b, LiaType type, int from, int to, double k, double z = 0.0) {
  scene::Lia& lia = b.scene.lias[at(b.link(type, from, to, k, z))];
  lia.scheme = scene::Scheme::kEnergyStable;
  lia.law.edit().nonlinearity = {1e4};
  lia.law.edit().stiffness_limit = {2.0 * k};
  lia.law.edit().tipping_point = std::sqrt(k / 1e4);
  lia.law.edit().exponent = {1.5};
  const bool is_bow = type == LiaType::kBow || type == LiaType::kSmoothBow;
  const bool snaps = type == LiaType::kConditional || type == LiaType::kOneWayPluck;
  lia.law.edit().width = {is_bow ? 0.1 : snaps ? 2e-4 : 0.0};
  lia.law.edit().release = 3e-4;
  if (type == LiaType::kTable) {
    lia.law.edit().table = {{{-1.0, -2.0 * k}, {0.0, 0.0}, {1.0, k}}, true};
    lia.law.edit().viscous_table = {{{-1.0, -0.2}, {0.0, 0.0}, {1.0, 0.1}}, false};
  }
  return lia;
}

TEST(EnergyStableLinksTest, BallLeavesAEnergyStableWallAsFastAsItCame) {
  SceneBuilder b;
  const int ball = b.mass(5e-3, -1e-3, 1.0);
  energyStable(b, LiaType::kPowerContact, ball, b.ground(), 1e7);
  b.hear(ball, 0, scene::Quantity::kVelocity);
  Player player(b.scene, kRates);
  player.ticks(20);
  EXPECT_NEAR(player.heard[0].back(), -1.0, 1e-12);
  std::vector<TankReport> reports = player.instrument->makeTankReports();
  player.instrument->readTanks(reports);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports[0].lia, 0);
  EXPECT_GT(reports[0].active, 3);
  EXPECT_LE(reports[0].clipped, reports[0].active);
}

constexpr LiaType kGuardable[] = {
    LiaType::kSpringDamper, LiaType::kContact,      LiaType::kQuadratic,    LiaType::kCubic,
    LiaType::kClippedCubic, LiaType::kCubicContact, LiaType::kPowerContact, LiaType::kTable,
    LiaType::kBow,          LiaType::kSmoothBow,    LiaType::kFelt,         LiaType::kConditional,
    LiaType::kOneWayPluck};

TEST(EnergyStableLinksTest, EveryLawBalancesInEveryGeometryAndAcrossRates) {
  for (const LiaType type : kGuardable) {
    for (const Geometry geometry : {Geometry::kScalar, Geometry::kPlane, Geometry::kSpace}) {
      SceneBuilder b;
      b.scene.sections[0].geometry = geometry;
      const int first = b.chain(12, 1e-3, 1000.0, 0.01);
      b.scene.mats[at(first + 7)].position.x() = 1e-3;
      const int hand = b.slice(0);
      const int slow = b.mass(0.1, 0.0, 0.3, SceneBuilder::kGestural);
      b.spring(slow, b.ground(0.0, SceneBuilder::kGestural), 500.0, 0.2);
      energyStable(b, type, hand, first + 5, 200.0, 0.1);
      energyStable(b, type, slow, first + 9, 200.0, 0.1);
      energyStable(b, type, first + 3, first + 6, 200.0, 0.1);
      energyStable(b, type, first + 5, first + 6, 200.0);
      Player player(b.scene, kRates);
      EXPECT_LT(imbalanceOf(player, 2000), 1e-10)
          << static_cast<int>(type) << " " << static_cast<int>(geometry);
    }
  }
}

/// A string with a place on it that a guide moves.
int movingPlace(SceneBuilder& b, int first, int columns, int guide) {
  const int place = b.point(b.grid(first, columns), 0.4);
  b.scene.connections.back().along.guide = guide;
  b.scene.connections.back().along.scale = 200.0;
  return place;
}

TEST(EnergyStableLinksTest, LinkOnAMovingPlaceBalances) {
  for (const LiaType type : {LiaType::kContact, LiaType::kCubic, LiaType::kSmoothBow}) {
    SceneBuilder b;
    const int first = b.chain(12, 1e-3, 1000.0, 0.01);
    b.scene.mats[at(first + 7)].position.x() = 1e-3;
    const int hand = b.slice(0);
    const int place = movingPlace(b, first, 14, hand);
    const int anvil = b.mass(0.02, 0.0, 0.1);
    b.spring(anvil, b.ground(), 100.0);
    energyStable(b, type, anvil, place, 5000.0, 0.2);
    energyStable(b, type, place, first + 3, 300.0);
    Player player(b.scene, kRates);
    EXPECT_LT(imbalanceOf(player, 2000), 1e-10) << static_cast<int>(type);
  }
}

/// A point between two masses weighs 1 / sum(w^2/M).
TEST(EnergyStableLinksTest, PlaceWeighsAsItsModulesDo) {
  constexpr double kShare = 0.3;
  SceneBuilder pair;
  const int first = pair.mass(2.5e-3, -1e-3, 1.0);
  const int second = pair.mass(5e-3, -1e-3, 1.0);
  const int place = pair.point(pair.grid(first, 2), kShare);
  energyStable(pair, LiaType::kContact, place, pair.ground(), 2e5);
  pair.hear(first, 0);
  pair.hear(second, 1);
  SceneBuilder single;
  const int ball = single.mass(1.0 / (0.49 / 2.5e-3 + 0.09 / 5e-3), -1e-3, 1.0);
  energyStable(single, LiaType::kContact, ball, single.ground(), 2e5);
  single.hear(ball);
  single.hear(ball, 1, Quantity::kVelocity);
  Player two(pair.scene, kRates);
  Player one(single.scene, kRates);
  two.ticks(20);
  one.ticks(20);
  for (std::size_t n = 0; n < one.heard[0].size(); ++n) {
    const double there = (1.0 - kShare) * two.heard[0][n] + kShare * two.heard[1][n];
    ASSERT_NEAR(there, one.heard[0][n], 1e-14) << n;
  }
  EXPECT_LT(one.heard[1].back(), -0.9) << "it was thrown back";
}

/// Two places between the same masses: only the difference of their weights works on each.
TEST(EnergyStableLinksTest, LinkBetweenPlacesOfOneStringActsByTheDifference) {
  const auto play = [](bool by_places) {
    SceneBuilder b;
    b.mass(1.0, 0.3);
    b.mass(1.0, -0.1);
    const int grid = b.grid(0, 2);
    const double share = by_places ? 1.0 : 0.3;  // of the elongation between the masses
    const int from = by_places ? b.point(grid, 0.3) : 0;
    const int to = by_places ? b.point(grid, 0.6) : 1;
    Lia& lia = energyStable(b, LiaType::kCubic, from, to, share * share * kRate * kRate);
    lia.law.edit().nonlinearity = {2.0 * std::pow(share, 4) * kRate * kRate};
    b.hear(0);
    Player player(b.scene, {kRate, 1});
    player.ticks(100);
    return player.heard[0];
  };
  const std::vector<double> places = play(true);
  const std::vector<double> difference = play(false);
  for (std::size_t n = 0; n < places.size(); ++n) {
    ASSERT_NEAR(places[n], difference[n], 1e-13) << n;
  }
  EXPECT_LT(difference.back(), 0.29);
}

TEST(EnergyStableLinksTest, EndsInOnePlaceOfSpaceDoNotPush) {
  SceneBuilder b;
  b.scene.sections[0].geometry = Geometry::kSpace;
  const int mass = b.mass(1.0);
  energyStable(b, LiaType::kContact, mass, b.mass(1.0), 1e6).law.edit().width = {1.0};
  b.hear(mass, 0, Quantity::kVelocity);
  Player player(b.scene, kRates);
  player.tick();
  EXPECT_EQ(player.heard[0].back(), 0.0);
}

/// A hand, whose next place nobody knows, throws a ball about.
TEST(EnergyStableLinksTest, WorkOfAHandIsCountedWithItsRealMotion) {
  SceneBuilder b;
  const int hand = b.slice(0);
  const int ball = b.mass(0.02, 1e-3, 0.0, SceneBuilder::kGestural);
  b.scene.sections[SceneBuilder::kGestural].gravity.x() = -9.81;
  energyStable(b, LiaType::kContact, hand, ball, 2e4, 0.5);
  Player player(b.scene, kRates);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1e-3, 1e-3);
  double work = 0.0;
  double pushed = 0.0;
  for (int n = 0; n < 5000; ++n) {
    const double x = player.positions[0];
    const double force = player.forces[0];
    player.positions[0] += n == 0 ? 0.0 : any(random) - 0.05 * x;
    player.tick();
    work -= 0.5 * (player.positions[0] - x) * (player.forces[0] + force);
    pushed += std::abs(player.forces[0]);
    const Energies energies = energiesOf(player);
    ASSERT_NEAR(energies.sections[SceneBuilder::kGestural].from_device, work,
                1e-9 * (1.0 + std::abs(work)));
    ASSERT_NEAR(energies.residual, 0.0, 1e-9 * (1.0 + std::abs(work)));
  }
  EXPECT_GT(pushed, 50.0);
}

TEST(EnergyStableLinksTest, WhatAHandPressesItHolds) {
  SceneBuilder b;
  energyStable(b, LiaType::kContact, b.slice(0), b.ground(0.0, SceneBuilder::kGestural), 1e4);
  Player player(b.scene, kRates);
  for (int n = 0; n < 20; ++n) {
    player.positions[0] = 1e-4 * std::min(n, 10);
    player.tick();
  }
  EXPECT_NEAR(energiesOf(player).stored, 0.5 * 1e4 * 1e-6, 1e-12);
}

TEST(EnergyStableLinksTest, TurningAKnobIsWorkOfTheKnob) {
  SceneBuilder b;
  b.scene.parameters.push_back({"k", 1.0, 0.5, 4.0, {}});
  const int mass = b.mass(1e-2, 1e-2);
  scene::Lia& lia = energyStable(b, LiaType::kCubic, mass, b.ground(), 300.0);
  lia.stiffness = {300.0, 0};
  Player player(b.scene, kRates);
  player.ticks(10);
  for (const double k : {4.0, 0.5, 1.0}) {
    player.instrument->exchange(player.instrument->prepare({k}));
    player.ticks(37);
    const Energies now = energiesOf(player);
    EXPECT_LT(std::abs(now.residual), 1e-10 * now.stored) << k;
  }
  const Energies e = energiesOf(player);
  EXPECT_NE(e.from_parameters, 0.0);
  EXPECT_LT(std::abs(e.sections[0].dissipated), 0.2 * e.stored);
}

/// What the knob has put into a stretched spring moves its mass.
TEST(EnergyStableLinksTest, StiffenedSpringGivesWhatItThenHolds) {
  SceneBuilder b;
  b.scene.parameters.push_back({"k", 300.0, 300.0, 1200.0, {}});
  const int mass = b.mass(1e-2, 1e-2);
  energyStable(b, LiaType::kCubic, mass, b.ground(), 0.0).stiffness = {1.0, 0};
  Player player(b.scene, kRates);
  player.tick();
  player.instrument->exchange(player.instrument->prepare({1200.0}));
  double kinetic = 0.0;
  for (int n = 0; n < 40; ++n) {
    player.tick();
    kinetic = std::max(kinetic, energiesOf(player).sections[0].kinetic);
  }
  EXPECT_NEAR(kinetic, 0.5 * 1200.0 * 1e-4, 1e-3);
}

TEST(EnergyStableLinksTest, SinglePrecisionPlaysTheSameAndKeepsABallBouncing) {
  SceneBuilder b;
  const int ball = b.mass(5e-3, -1e-3, 1.0);
  energyStable(b, LiaType::kPowerContact, ball, b.ground(), 1e7);
  b.hear(ball, 0, scene::Quantity::kVelocity);
  Player player(b.scene, kRates, Precision::kFloat);
  player.ticks(20);
  EXPECT_NEAR(player.heard[0].back(), -1.0, 1e-5);
  b.scene.mats[at(ball)].push.edit().force.x() = 0.5;  // back to the wall, some 200 times a second
  Player bouncing(b.scene, kRates, Precision::kFloat);
  bouncing.ticks(1000000 / kRates.ratio);
  const std::vector<double>& v = bouncing.heard[0];
  const double expected = std::sqrt(1.0 + 2.0 * 0.5 / 5e-3 * 1e-3);
  EXPECT_NEAR(*std::max_element(v.end() - 10000, v.end()), expected, 0.02 * expected);
}

constexpr double kBowSpeed = 0.2;
constexpr double kBowForce = 0.5;

/// Stick-slip period of the oscillator of the reference, at this rate, under
/// F = N sqrt(2a) v exp(-a v^2 + 1/2) as the smooth bow says it.
double periodAt(double rate, double steepness) {
  constexpr double kMass = 1e-3;
  constexpr double kOmega = 2.0 * kPi * 200.0;
  constexpr double kDampingRatio = 0.01;
  SceneBuilder b;
  const int mass =
      b.cell(kMass, kMass * kOmega * kOmega, 2.0 * kDampingRatio * kOmega * kMass, 0.0, kBowSpeed);
  const int bow = b.mass(1e15, 0.0, kBowSpeed);
  b.link(LiaType::kSmoothBow, bow, mass, 0.0, kBowForce * std::sqrt(2.0 * steepness) / 0.63);
  b.scene.lias[0].law.edit().width = {2.0 / std::sqrt(steepness)};
  b.scene.lias[0].scheme = Scheme::kEnergyStable;
  b.hear(mass, 0);
  b.hear(mass, 1, Quantity::kVelocity);
  Player player(b.scene, {rate, 1});
  std::vector<double> turns;
  double before = kBowSpeed;
  for (int n = 0; n < static_cast<int>(rate) && turns.size() < 60; ++n) {
    player.tick();
    const double v = player.heard[1].back();
    if (before > 0.0 && v <= 0.0 && player.heard[0].back() > 0.0) {
      turns.push_back(n + before / (before - v));
    }
    before = v;
  }
  EXPECT_EQ(turns.size(), 60U);
  return (turns.back() - turns[turns.size() - 21]) / 20.0 / rate;
}

TEST(EnergyStableFrictionTest, StickSlipPeriodIsThatOfTheContinuousModel) {
  for (const reference::BowPeriod& r : reference::kBowPeriods) {
    const double coarse = std::abs(periodAt(88200.0, r.steepness) / r.period_s - 1.0);
    const double fine = std::abs(periodAt(176400.0, r.steepness) / r.period_s - 1.0);
    EXPECT_LT(coarse, 5e-4) << r.steepness;
    EXPECT_LT(fine, 0.5 * coarse) << r.steepness;
  }
}

/// A unit mass that slips on a bow at rest whose friction rises by h F'/M = `steepness`; the width
/// of its curve is 1 m per step.
SceneBuilder rubbed(LiaType type, double steepness, double speed) {
  SceneBuilder b;
  const int mass = b.mass(1.0, 0.0, speed * kRate);
  Lia& lia = b.scene.lias[at(b.link(type, mass, b.ground(), 0.0, steepness * kRate))];
  lia.law.edit().width = {kRate};
  if (type == LiaType::kBowTable) {
    const double height = 0.1 * steepness * kRate * kRate;
    lia.law.edit().table.points = {
        {-kRate, 0.0}, {-0.1 * kRate, -height}, {0.1 * kRate, height}, {kRate, 0.0}};
  }
  lia.scheme = Scheme::kEnergyStable;
  b.hear(mass, 0, Quantity::kVelocity);
  return b;
}

void expectOnlySlowed(const SceneBuilder& b, double steepness) {
  Player player(b.scene, {kRate, 1});
  player.tick();
  double before = player.heard[0].back();
  for (int n = 0; n < 200; ++n) {
    player.tick();
    const double v = player.heard[0].back();
    // The slip that the force works on is the mean of both sides of the step.
    ASSERT_GE((v + before) * before, -1e-15 * kRate * kRate) << steepness;
    ASSERT_LE(v * v, before * before * (1.0 + 1e-15)) << steepness;
    before = v;
  }
  EXPECT_LT(std::abs(energiesOf(player).residual), 1e-14 * kRate * kRate) << steepness;
  EXPECT_GT(energiesOf(player).sections[0].dissipated, 0.0);
}

TEST(EnergyStableFrictionTest, SteepFrictionNeverReversesTheSlipAndAlwaysDissipates) {
  for (const double steepness : {0.1, 1.0, 2.0, 3.0, 10.0, 100.0, 1e4, 1e8}) {
    expectOnlySlowed(rubbed(LiaType::kBow, 1.5 * steepness, 0.9), steepness);
    expectOnlySlowed(rubbed(LiaType::kBowTable, steepness, 0.9), steepness);
    expectOnlySlowed(rubbed(LiaType::kSmoothBow, steepness, 0.9), steepness);
  }
}

/// The same friction from the slip before the step.
TEST(EnergyStableFrictionTest, ExplicitFrictionOfThatSteepnessReversesTheSlip) {
  SceneBuilder b = rubbed(LiaType::kBow, 1.5 * 3.0, 0.3);
  b.scene.lias[0].scheme = Scheme::kExplicit;
  Player player(b.scene, {kRate, 1});
  player.ticks(51);
  const std::vector<double>& v = player.heard[0];
  int reversals = 0;
  for (std::size_t n = 1; n < v.size(); ++n) {
    reversals += (v[n] + v[n - 1]) * v[n - 1] < 0.0 ? 1 : 0;
  }
  EXPECT_GT(reversals, 10);
}

TEST(EnergyStableFrictionTest, RoughGroundHoldsAMassAgainstALoad) {
  SceneBuilder b = rubbed(LiaType::kBow, 1e6, 0.0);
  b.scene.lias[0].law.edit().width = {0.1 * kRate};
  b.scene.mats[0].push.edit().force.x() = 0.01 * kRate * kRate;
  b.hear(0, 1);
  Player player(b.scene, {kRate, 1});
  player.ticks(10000);
  EXPECT_LT(std::abs(player.heard[1].back()), 0.01);
  EXPECT_LT(player.heard[0].back(), 1e-7 * kRate);
}

/// What a bow, contacts and springs on the same masses dissipate: only the bow does, in every step.
TEST(EnergyStableFrictionTest, BowOnEnergyStableSpringsKeepsTheBalance) {
  constexpr int kMasses = 12;
  SceneBuilder b;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  const double unit = kRate * kRate;
  const int wall = b.ground();
  for (int m = 1; m <= kMasses; ++m) {
    b.mass(1.0, anywhere(random));
    b.hear(m, 3 * m, Quantity::kVelocity);
    b.link(LiaType::kContact, m, wall, 2.0 * unit);
    b.scene.lias.back().law.edit().width = {-0.2};
    if (m > 1) {
      b.link(LiaType::kCubic, m - 1, m, 0.1 * unit);
      b.scene.lias.back().law.edit().nonlinearity = {0.3 * unit};
    }
  }
  const int place = b.point(b.grid(1, kMasses), 4.6 / (kMasses - 1));
  b.link(LiaType::kBow, place, wall, 0.0, 5.0 * kRate);
  b.scene.lias.back().law.edit().width = {0.05 * kRate};
  for (Lia& lia : b.scene.lias) {
    lia.scheme = Scheme::kEnergyStable;
  }
  Player player(b.scene, {kRate, 1});
  player.tick();
  const double at_start = energiesOf(player).stored;
  double heat = test::tankStatesOf(player).back().lost;
  double whole = 0.0;  // energy and heat
  for (int n = 0; n < 20000; ++n) {
    const std::vector<EnergyStableState<double>> tanks = test::tankStatesOf(player);
    ASSERT_GE(tanks.back().lost, heat * (1.0 - 1e-14)) << n;
    heat = tanks.back().lost;
    player.tick();
    const double now = test::energyBetweenSteps(player, tanks) + test::heatOf(tanks);
    whole = n == 0 ? now : whole;
    ASSERT_NEAR(now / whole, 1.0, 1e-12) << n;
    ASSERT_NEAR(test::heatOf(tanks), heat, 1e-9 * whole) << n;
  }
  EXPECT_GT(heat, 0.1 * at_start);
}

}  // namespace
}  // namespace ergotic::physics
