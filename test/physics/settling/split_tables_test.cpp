// SPDX-License-Identifier: BSD-3-Clause
// Tables that push outwards, and what holds them.
#include "physics/settling/split_tables.hpp"

#include <cmath>

#include "ergotic/physics/certificate/certify.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr Rates kRates{kRate, 1};
constexpr double kStiffness = 1e6;  // N/m, of the spring that holds

using Points = std::vector<std::pair<double, double>>;

const Points kOutward = {{-1e-3, 100.0}, {1e-3, -100.0}};
const Points kSlanted = {{-1e-3, 50.0}, {0.0, 60.0}, {1e-3, 300.0}};
const Points kConstant = {{-1.0, 5.0}, {1.0, 5.0}};
const Points kBrake = {{-2.0, -3.0}, {0.0, 2.0}, {0.5, 20.0}};

/// A mass on a spring, and a table between it and the ground.
SceneBuilder held(const Points& elastic, const Points& viscous, double x = 0.0, double v = 0.0) {
  SceneBuilder b;
  const int mass = b.mass(1.0, x, v);
  b.spring(mass, b.ground(), kStiffness);
  scene::Lia& table = b.scene.lias[at(b.link(LiaType::kTable, mass, b.ground(), 0.0))];
  table.law.edit().table.points = elastic;
  table.law.edit().viscous_table.points = viscous;
  table.scheme = Scheme::kAuto;
  b.hear(mass);
  return b;
}

TEST(SplitTablesTest, WhatTheSpringsHoldIsSplit) {
  for (const auto& [elastic, viscous, force] : {std::tuple(kSlanted, Points{}, 50.0),
                                                {Points{}, kConstant, 5.0},
                                                {kSlanted, kConstant, 55.0}}) {
    const scene::Scene scene = settle(held(elastic, viscous).scene, kRates).scene;
    ASSERT_EQ(scene.lias.size(), 3U);
    const scene::Lia& rest = scene.lias[1];
    const scene::Lia& push = scene.lias[2];
    EXPECT_EQ(push.name, "l1.push");
    EXPECT_EQ(push.scheme, Scheme::kExplicit);
    EXPECT_NEAR(push.stiffness.factor, -1e-3 * kStiffness, 1e-2);
    EXPECT_NEAR(push.stiffness.factor * -push.rest_length, force, 1e-6);
    EXPECT_EQ(rest.scheme, Scheme::kGuarded);
    EXPECT_EQ(rest.stiffness.factor, -push.stiffness.factor);
    EXPECT_EQ(rest.law->width.factor, push.rest_length);
    EXPECT_LE(certify(scene, kRates).verdict, Verdict::kBounded);
  }
}

TEST(SplitTablesTest, WhatHasAFloorStaysWhole) {
  const Points well = {{-1e-3, -10.0}, {1e-3, 10.0}};
  for (const auto& [elastic, viscous] : {std::pair(well, Points{}), {well, kConstant}}) {
    const scene::Scene scene = settle(held(elastic, viscous).scene, kRates).scene;
    EXPECT_EQ(scene.lias.size(), 2U);
    EXPECT_EQ(scene.lias[1].scheme, Scheme::kGuarded);
    EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kPassive);
  }
}

/// A mass that a constant force takes away is nothing to vouch for, and nothing to hold back.
TEST(SplitTablesTest, WhatNothingHoldsIsNotVouchedFor) {
  for (const double stiffness : {0.0, -1e-3, 1e-3}) {
    SceneBuilder b = held({}, kConstant);
    b.scene.lias[0].b = b.mass(1.0);
    b.scene.lias[0].stiffness = {stiffness};
    const scene::Scene scene = settle(b.scene, kRates).scene;
    EXPECT_EQ(scene.lias.size(), 2U);
    EXPECT_EQ(scene.lias[1].scheme, Scheme::kExplicit);
    EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kUnproven);
  }
}

/// Each takes away a share of what the ones before have left.
TEST(SplitTablesTest, ManyTakeNoMoreThanThereIs) {
  SceneBuilder b = held(kSlanted, {});
  for (int n = 0; n < 6; ++n) {
    b.scene.lias.push_back(b.scene.lias[1]);
  }
  const scene::Scene scene = settle(b.scene, kRates).scene;
  EXPECT_EQ(scene.lias.size(), 1U + 2U * 7U);
  EXPECT_EQ(certify(scene, kRates).verdict, Verdict::kPassive);
}

TEST(SplitTablesTest, ConstantForceMovesTheRest) {
  Player player(held({}, kConstant).scene, kRates);
  player.ticks(3000);
  const auto [low, high] = std::minmax_element(player.heard[0].begin(), player.heard[0].end());
  EXPECT_NEAR(*low, -2.0 * 5.0 / kStiffness, 1e-9);
  EXPECT_NEAR(*high, 0.0, 1e-9);
}

/// Between two ways out there may be a well that is less deep: a tank would know of those alone.
TEST(SplitTablesTest, WhatPushesOutwardsOnBothSidesStaysWhole) {
  for (const auto& [viscous, scheme] :
       {std::pair(Points{}, Scheme::kGuarded), {kConstant, Scheme::kExplicit}}) {
    const scene::Scene scene = settle(held(kOutward, viscous).scene, kRates).scene;
    EXPECT_EQ(scene.lias.size(), 2U);
    EXPECT_EQ(scene.lias[1].scheme, scheme);
  }
}

TEST(SplitTablesTest, EnergyIsKeptWhereNothingIsLost) {
  for (const auto& [elastic, viscous] : {std::pair(kSlanted, Points{}), {kSlanted, kConstant}}) {
    Player player(held(elastic, viscous, 3e-3, 1.0).scene, kRates);
    EXPECT_LT(imbalanceOf(player, 5000), 1e-12);
    EXPECT_NEAR(energiesOf(player).sections[0].dissipated, 0.0, 1e-9);
  }
}

TEST(SplitTablesTest, PlaysAsTheExplicitOneWhereTheStepIsSmall) {
  for (const auto& [elastic, viscous] : {std::pair(kSlanted, Points{}),
                                         {kSlanted, kConstant},
                                         {kSlanted, kBrake},
                                         {Points{}, kBrake}}) {
    SceneBuilder b = held(elastic, viscous, 2e-4, 0.3);
    Player split(b.scene, {10.0 * kRate, 1});
    b.scene.lias[1].scheme = Scheme::kExplicit;
    Player whole(b.scene, {10.0 * kRate, 1});
    split.ticks(20000);
    whole.ticks(20000);
    for (std::size_t n = 0; n < whole.heard[0].size(); ++n) {
      ASSERT_NEAR(split.heard[0][n], whole.heard[0][n], 1e-6) << n;
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
