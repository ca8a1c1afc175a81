// SPDX-License-Identifier: BSD-3-Clause
// The energy accounts balance to rounding, whatever moves.

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr LiaType kAllTypes[] = {
    LiaType::kSpringDamper, LiaType::kContact,      LiaType::kQuadratic,  LiaType::kCubic,
    LiaType::kClippedCubic, LiaType::kCubicContact, LiaType::kPluck,      LiaType::kBow,
    LiaType::kSmoothBow,    LiaType::kPowerContact, LiaType::kTable,      LiaType::kConditional,
    LiaType::kFelt,         LiaType::kRelaxing,     LiaType::kOneWayPluck};

double imbalance(const scene::Scene& scene, const Rates& rates, int ticks) {
  Player player(scene, rates);
  return imbalanceOf(player, ticks, 97);
}

/// Every field that some law reads, for forces of some newtons at some millimetres.
void shape(Lia& lia) {
  const bool is_gap = lia.type == LiaType::kContact || lia.type == LiaType::kPowerContact ||
                      lia.type == LiaType::kFelt;
  lia.law.edit().nonlinearity = {1e4};
  lia.law.edit().stiffness_limit = {400.0};
  lia.law.edit().limit_damping = {0.05};
  lia.law.edit().tipping_point = std::sqrt(200.0 / 1e4);
  lia.law.edit().exponent = {1.5};
  lia.law.edit().width = {is_gap ? 0.0 : 0.01};
  lia.law.edit().release = 0.02;
  if (lia.type == LiaType::kRelaxing) {
    lia.law.edit().relaxations = {{{50.0}, 1e-3}, {{100.0}, 1e-4}};
  }
  if (lia.type == LiaType::kTable) {
    lia.stiffness = {};
    lia.damping = {};
    lia.law.edit().table = {{{-0.01, -2.0}, {-1e-3, -0.1}, {1e-3, 0.1}, {0.01, 2.0}}, true};
  }
}

/// A string, a slow mass on a spring and a hand, joined by links of one type.
SceneBuilder stringAndHand(LiaType type, Geometry geometry = Geometry::kScalar) {
  SceneBuilder b;
  for (scene::Section& section : b.scene.sections) {
    section.geometry = geometry;
  }
  const int first = b.chain(30, 1e-3, 1000.0, 0.01);
  for (int m = 0; m < 32 && geometry != Geometry::kScalar; ++m) {
    scene::Mat& mat = b.scene.mats[at(first + m)];
    mat.rest = mat.position = {0.01 * m, 0.0, 0.0};
  }
  for (Lia& lia : b.scene.lias) {
    lia.rest_length = geometry == Geometry::kScalar ? 0.0 : 0.009;
  }
  b.scene.mats[at(first + 7)].position += Eigen::Vector3d(1e-3, 2e-3, 5e-4);
  const int hand = b.slice(0);
  const int slow = b.mass(0.1, 0.0, 0.3, SceneBuilder::kGestural);
  b.spring(slow, b.ground(0.0, SceneBuilder::kGestural), 500.0, 0.2);
  for (const auto& [x, y] :
       {std::pair(hand, first + 5), {slow, first + 9}, {first + 3, first + 11}}) {
    shape(b.scene.lias[at(b.link(type, x, y, 200.0, 0.1))]);
  }
  return b;
}

/// The hand moves its module along every coordinate.
void holdAlongAllAxes(SceneBuilder& b) {
  for (int axis = 1; axis < dimensionsOf(b.scene.sections[1].geometry); ++axis) {
    b.scene.ports.push_back(b.scene.ports.front());
    b.scene.ports.back().axis = axis;
  }
}

/// The same with a link inside the string that is energy-stable.
SceneBuilder energyStableString(LiaType type, Geometry geometry = Geometry::kScalar) {
  SceneBuilder b = stringAndHand(LiaType::kSpringDamper, geometry);
  for (const auto& [x, y] : {std::pair(4, 12), {10, 12}, {12, 20}}) {
    Lia& lia = b.scene.lias[at(b.link(type, x, y, 200.0, 0.0))];
    shape(lia);
    lia.damping =
        type == LiaType::kBow || type == LiaType::kSmoothBow ? scene::Value{0.1} : scene::Value{};
    lia.scheme = Scheme::kEnergyStable;
  }
  return b;
}

class EnergyTest : public testing::TestWithParam<int> {};

TEST_P(EnergyTest, ChainUnderGravityBalances) {
  SceneBuilder b;
  const int first = b.chain(30, 1e-3, 1000.0, 0.01);
  b.scene.mats[at(first + 7)].position.x() = 1e-3;
  b.scene.sections[0].gravity.x() = -9.81;
  EXPECT_LT(imbalance(b.scene, {kRate, GetParam()}, 5000), kUnbalanced);
}

TEST_P(EnergyTest, EveryLawBalancesAcrossRates) {
  for (const LiaType type : kAllTypes) {
    const SceneBuilder b = stringAndHand(type);
    EXPECT_LT(imbalance(b.scene, {kRate, GetParam()}, 3000), kUnbalanced)
        << "type " << static_cast<int>(type);
  }
}

TEST_P(EnergyTest, EveryEnergyStableLawBalances) {
  for (const LiaType type : kAllTypes) {
    const SceneBuilder b = energyStableString(type);
    if (scene::canBeEnergyStable(b.scene, b.scene.lias.back())) {
      EXPECT_LT(imbalance(b.scene, {kRate, GetParam()}, 3000), kUnbalanced)
          << "type " << static_cast<int>(type);
    }
  }
}

TEST_P(EnergyTest, TablesOfPluckBowAndViscosityBalance) {
  for (const LiaType type : {LiaType::kPluckTable, LiaType::kBowTable, LiaType::kTable}) {
    SceneBuilder b = stringAndHand(type);
    for (Lia& lia : b.scene.lias) {
      if (lia.type == type) {
        lia.stiffness = {};
        lia.law.edit().table = {{{-0.02, 0.0}, {-0.01, -1.0}, {0.01, 1.0}, {0.02, 0.0}}, false};
        lia.law.edit().viscous_table = {{{-1.0, -0.2}, {1.0, 0.2}}, false};
      }
    }
    EXPECT_LT(imbalance(b.scene, {kRate, GetParam()}, 3000), kUnbalanced)
        << "type " << static_cast<int>(type);
  }
}

TEST_P(EnergyTest, EveryGeometryBalancesWithEveryOther) {
  for (const Geometry geometry : {Geometry::kLine, Geometry::kPlane, Geometry::kSpace}) {
    for (const LiaType type : {LiaType::kSpringDamper, LiaType::kCubic, LiaType::kSmoothBow}) {
      SceneBuilder b = type == LiaType::kCubic ? energyStableString(type, geometry)
                                               : stringAndHand(type, geometry);
      holdAlongAllAxes(b);
      b.scene.sections[0].medium = {1e-4};
      EXPECT_LT(imbalance(b.scene, {kRate, GetParam()}, 2000), kUnbalanced)
          << static_cast<int>(geometry) << " " << static_cast<int>(type);
      b.scene.sections[1].geometry = Geometry::kScalar;  // links are projected
      b.scene.ports.resize(1);
      EXPECT_LT(imbalance(b.scene, {kRate, GetParam()}, 2000), kUnbalanced)
          << static_cast<int>(geometry) << " " << static_cast<int>(type) << " and scalar";
    }
  }
}

/// A point of the string that the hand pushes along, with one spring to the ground, one to the
/// hand.
TEST_P(EnergyTest, MovingPlaceBalances) {
  for (const bool is_energy_stable : {false, true}) {
    SceneBuilder b;
    const int first = b.chain(30, 1e-3, 1000.0, 0.01);
    b.scene.mats[at(first + 7)].position.x() = 1e-3;
    const int finger = b.point(b.grid(first, 32), 0.1);
    const int hand = b.slice(0);
    scene::Connection& place = b.scene.connections[0];
    place.along.guide = hand;
    place.along.scale = 300.0;
    place.along.maximum = 0.9;
    b.spring(b.ground(), finger, 300.0, 0.1);
    b.spring(hand, finger, 30.0, 0.1);
    if (is_energy_stable) {
      Lia& lia = b.scene.lias[at(b.link(LiaType::kCubic, b.ground(), finger, 300.0))];
      lia.law.edit().nonlinearity = {1e7};
      lia.scheme = Scheme::kEnergyStable;
    }
    EXPECT_LT(imbalance(b.scene, {kRate, GetParam()}, 5000), kUnbalanced) << is_energy_stable;
  }
}

INSTANTIATE_TEST_SUITE_P(Ratios, EnergyTest, testing::Values(1, 4, 14, 44));

/// A damper of one section takes what it did in the last step, that of the hand too.
TEST(EnergyOfHandsTest, DampersOnThemBalance) {
  SceneBuilder b;
  const int hand = b.slice(0);
  b.spring(hand, b.mass(0.1, 0.0, 0.0, SceneBuilder::kGestural), 500.0, 1.0);
  EXPECT_LT(imbalance(b.scene, {kRate, 14}, 2000), kUnbalanced);
}

/// What flies off a wall has left nothing there of what it held at the start.
TEST(EnergyOfContactsTest, HoldAtTheStartWhatTheyGive) {
  SceneBuilder b;
  const int ball = b.mass(1.0, 1e-3, 1e-4 * kRate);
  b.link(LiaType::kContact, ball, b.ground(), 0.01 * kRate * kRate);
  b.scene.lias[0].scheme = Scheme::kExplicit;
  Player player(b.scene, {kRate, 1});
  player.tick();
  const double start = energiesOf(player).stored;
  player.ticks(100);
  EXPECT_NEAR(energiesOf(player).sections[0].potential, 0.0, 0.01 * start);
  EXPECT_NEAR(energiesOf(player).sections[0].kinetic, start, 0.01 * start);
}

/// Sections at every 28th frame and at every second one beside the tick of 14: energy-stable links
/// of a slow section are read in the middle of its step.
TEST(EnergyOfManyRatesTest, Balances) {
  for (const Scheme scheme : {Scheme::kExplicit, Scheme::kEnergyStable}) {
    SceneBuilder b = stringAndHand(LiaType::kSpringDamper);
    scene::Section slower = b.scene.sections[0];
    slower.name = "slower";
    slower.divisor = 28;
    b.scene.sections.push_back(slower);
    b.scene.sections[0].divisor = 2;
    const int heavy = b.mass(1.0, 0.0, 0.5, 2);
    const int other = b.mass(0.5, 1e-3, 0.0, 2);
    b.spring(heavy, b.ground(0.0, 2), 500.0, 0.1);
    b.spring(heavy, 9, 50.0, 0.01);
    for (const auto& [x, y] : {std::pair(heavy, other), {b.ground(0.0, 2), other}}) {
      Lia& lia = b.scene.lias[at(b.link(LiaType::kCubic, x, y, 2e4))];
      lia.law.edit().nonlinearity = {1e10};
      lia.scheme = scheme;
    }
    EXPECT_LT(imbalance(b.scene, {kRate, 14}, 6000), kUnbalanced)
        << (scheme == Scheme::kEnergyStable);
  }
}

TEST(EnergyOfManyStepsTest, AllKindsBalanceOverAMillion) {
  SceneBuilder b = energyStableString(LiaType::kContact);
  for (const auto& [type, x, y] : {std::tuple(LiaType::kPowerContact, 6, 22),
                                   {LiaType::kCubic, 8, 24},
                                   {LiaType::kSmoothBow, 14, 28}}) {
    Lia& lia = b.scene.lias[at(b.link(type, x, y, 100.0, type == LiaType::kSmoothBow ? 0.01 : 0))];
    shape(lia);
    lia.scheme = Scheme::kAuto;
  }
  const int cell = b.cell(1e-3, 1000.0, 0.0, 1e-3);
  b.scene.mats[at(cell)].matched = true;
  b.spring(cell, 16, 100.0);
  const int ratio = 14;
  EXPECT_LT(imbalance(b.scene, {kRate, ratio}, 1'000'000 / ratio + 1), kUnbalanced);
}

/// Every law, explicit and energy-stable where it can be, a matched cell and a third rate; nothing
/// moves it from outside.
scene::Scene closedNetwork(Geometry geometry) {
  SceneBuilder b = stringAndHand(LiaType::kSpringDamper, geometry);
  for (scene::Mat& mat : b.scene.mats) {
    mat.type = mat.type == scene::MatType::kSlice ? scene::MatType::kGround : mat.type;
  }
  b.scene.ports.clear();
  int low = 2;
  for (const LiaType type : kAllTypes) {
    for (const bool is_energy_stable : {false, true}) {
      Lia& lia = b.scene.lias[at(b.link(type, low, low + 3, 100.0))];
      shape(lia);
      lia.damping = {is_energy_stable ? 0.0 : 1e-3};
      lia.scheme = is_energy_stable && scene::canBeEnergyStable(b.scene, lia)
                       ? Scheme::kEnergyStable
                       : Scheme::kExplicit;
    }
    low += 2;
  }
  const int cell = b.cell(1e-3, 1000.0, 1e-3, 1e-3);
  b.scene.mats[at(cell)].matched = true;
  b.scene.mats[at(cell)].rest = b.scene.mats[16].rest;
  b.spring(cell, 16, 100.0);
  scene::Section third = b.scene.sections[0];
  third.name = "third";
  third.divisor = 2;
  b.scene.sections.push_back(third);
  b.spring(b.mass(0.01, 0.0, 0.1, 2), 12, 20.0, 1e-3);
  return b.scene;
}

class ClosedNetworkTest : public testing::TestWithParam<std::pair<Geometry, int>> {};

TEST_P(ClosedNetworkTest, BalancesOverAMillionSteps) {
  const auto [geometry, ratio] = GetParam();
  const int ticks = 1'000'000 / ratio + 1;
  EXPECT_LT(imbalance(closedNetwork(geometry), {kRate, ratio}, ticks), kUnbalanced);
}

INSTANTIATE_TEST_SUITE_P(Geometries,
                         ClosedNetworkTest,
                         testing::Values(std::pair(Geometry::kScalar, 14),
                                         std::pair(Geometry::kLine, 4),
                                         std::pair(Geometry::kPlane, 44),
                                         std::pair(Geometry::kSpace, 14)));

}  // namespace
}  // namespace ergotic::physics
