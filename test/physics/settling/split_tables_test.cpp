// SPDX-License-Identifier: BSD-3-Clause
// Tables that push outwards or drive, and what holds them.
#include <cmath>

#include "ergotic/physics/certificate/certify.hpp"
#include "physics/settling/steps.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kHoldingStiffness = 1e6;  // N/m, of the spring that holds

using Points = std::vector<std::pair<double, double>>;

const Points kOutward = {{-1e-3, 100.0}, {1e-3, -100.0}};
const Points kSlanted = {{-1e-3, 50.0}, {0.0, 60.0}, {1e-3, 300.0}};
const Points kConstant = {{-1.0, 5.0}, {1.0, 5.0}};
const Points kBrake = {{-2.0, -3.0}, {0.0, 2.0}, {0.5, 20.0}};
const Points kDrive = {{-2.0, 50.0}, {0.0, 5.0}, {1.0, -45.0}, {2.0, 20.0}};  // falls by 50 N s/m

/// A mass on a spring and a damper, and a table between it and the ground.
SceneBuilder held(const Points& elastic,
                  const Points& viscous,
                  double x = 0.0,
                  double v = 0.0,
                  double damping = 0.0) {
  SceneBuilder b;
  const int mass = b.mass(1.0, x, v);
  b.spring(mass, b.ground(), kHoldingStiffness, damping);
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
    const scene::Scene scene = settle(held(elastic, viscous).scene, kEveryFrame).scene;
    ASSERT_EQ(scene.lias.size(), 3U);
    const scene::Lia& rest = scene.lias[1];
    const scene::Lia& push = scene.lias[2];
    EXPECT_EQ(push.name, "l1.push");
    EXPECT_EQ(push.scheme, Scheme::kExplicit);
    EXPECT_NEAR(push.stiffness.factor, -1e-3 * kHoldingStiffness, 3e-5 * kHoldingStiffness * 1e-3);
    EXPECT_NEAR(push.stiffness.factor * -push.rest_length, force, 1e-6);
    EXPECT_EQ(rest.scheme, Scheme::kEnergyStable);
    EXPECT_EQ(rest.stiffness.factor, -push.stiffness.factor);
    EXPECT_EQ(rest.law->width.factor, push.rest_length);
    EXPECT_LE(certify(scene, kEveryFrame).verdict, Verdict::kBounded);
  }
}

TEST(SplitTablesTest, WhatHasAFloorStaysWhole) {
  const Points well = {{-1e-3, -10.0}, {1e-3, 10.0}};
  for (const auto& [elastic, viscous] : {std::pair(well, Points{}), {well, kConstant}}) {
    const scene::Scene scene = settle(held(elastic, viscous).scene, kEveryFrame).scene;
    EXPECT_EQ(scene.lias.size(), 2U);
    EXPECT_EQ(scene.lias[1].scheme, Scheme::kEnergyStable);
    EXPECT_EQ(certify(scene, kEveryFrame).verdict, Verdict::kPassive);
  }
}

/// A mass that a constant force takes away cannot be certified, and nothing holds it back.
TEST(SplitTablesTest, WhatNothingHoldsIsNotCertified) {
  for (const double stiffness : {0.0, -1e-3, 1e-3}) {
    SceneBuilder b = held({}, kConstant);
    b.scene.lias[0].b = b.mass(1.0);
    b.scene.lias[0].stiffness = {stiffness};
    const scene::Scene scene = settle(b.scene, kEveryFrame).scene;
    EXPECT_EQ(scene.lias.size(), 2U);
    EXPECT_EQ(scene.lias[1].scheme, Scheme::kExplicit);
    EXPECT_EQ(certify(scene, kEveryFrame).verdict, Verdict::kUnproven);
  }
}

/// What the mass is held and braked by, and what a table falls by: nine tenths of that may be taken
/// away.
struct Limit {
  Points elastic;
  Points viscous;
  double stiffness;
  double damping;
};
const Limit kAtTheLimit[] = {
    {kOutward, {}, 1e5 / 0.9, 0.0},
    {kOutward, kConstant, 1e5 / 0.9, 0.0},
    {{}, kDrive, 1.0, 50.0 / 0.9},
    {kSlanted, kDrive, 1.0, 50.0 / 0.9},
    {kOutward, kDrive, 1e5 / 0.9, 50.0 / 0.9},
};

SceneBuilder atALimit(const Limit& limit, double of_stiffness, double of_damping) {
  SceneBuilder b = held(limit.elastic, limit.viscous, 1e-3, 1.0, of_damping * limit.damping);
  b.scene.lias[0].stiffness = {of_stiffness * limit.stiffness};
  return b;
}

TEST(SplitTablesTest, WhatIsLeftNowhereFalls) {
  for (const Limit& limit : kAtTheLimit) {
    const scene::Scene scene = settle(atALimit(limit, 1.01, 1.01).scene, kEveryFrame).scene;
    ASSERT_EQ(scene.lias.size(), 3U);
    const scene::Lia& rest = scene.lias[1];
    const scene::Lia& push = scene.lias[2];
    EXPECT_NEAR(push.stiffness.factor, limit.elastic == kOutward ? -1e5 : 0.0, 0.1);
    EXPECT_NEAR(push.damping.factor, limit.damping > 0.0 ? -50.0 : 0.0, 1e-9);
    EXPECT_EQ(push.scheme, Scheme::kExplicit);
    EXPECT_EQ(rest.scheme, Scheme::kEnergyStable);
    EXPECT_EQ(rest.stiffness.factor, -push.stiffness.factor);
    EXPECT_EQ(rest.damping.factor, -push.damping.factor);
    EXPECT_LE(certify(scene, kEveryFrame).verdict, Verdict::kBounded);
  }
}

TEST(SplitTablesTest, WhatIsHeldAndBrakedTooLittleStaysWhole) {
  for (const Limit& limit : kAtTheLimit) {
    for (const auto& [stiffness, damping] : {std::pair(0.99, 1.01), {1.01, 0.99}}) {
      if ((stiffness < 1.0 && limit.stiffness < 1e5) || (damping < 1.0 && limit.damping == 0.0)) {
        continue;
      }
      const scene::Scene scene =
          settle(atALimit(limit, stiffness, damping).scene, kEveryFrame).scene;
      EXPECT_EQ(scene.lias.size(), 2U);
      if (!limit.viscous.empty()) {
        EXPECT_EQ(scene.lias[1].scheme, Scheme::kExplicit);
        EXPECT_EQ(certify(scene, kEveryFrame).verdict, Verdict::kUnproven);
      }
    }
  }
}

/// Braked by a little more than it drives it comes to rest; by a little less it does not.
TEST(SplitTablesTest, WhatDrivesGrowsUnlessItIsBraked) {
  const Points drive = {{-1e3, 5e4}, {1e3, -5e4}};
  const auto speedWith = [&](double damping) {
    Player player(held({}, drive, 0.0, 1.0, damping).scene, kEveryFrame);
    player.ticks(static_cast<int>(2.0 * kRate));
    return std::sqrt(2.0 * energiesOf(player).sections[0].kinetic);
  };
  EXPECT_LT(speedWith(56.0), 0.1);
  EXPECT_GT(speedWith(45.0), 10.0);
}

/// Not all that is joined is braked.
TEST(SplitTablesTest, DamperOfANeighbourBrakesNothing) {
  SceneBuilder b = held({}, kDrive, 0.0, 0.0);
  b.spring(b.mass(1.0), 0, kHoldingStiffness);
  b.spring(2, 1, 0.0, 1e3);
  const scene::Scene scene = settle(b.scene, kEveryFrame).scene;
  EXPECT_EQ(scene.lias.size(), 4U);
  EXPECT_EQ(certify(scene, kEveryFrame).verdict, Verdict::kUnproven);
}

/// Through a damper to a slice the table would drive whoever holds that, and lets go.
TEST(SplitTablesTest, HandHoldsNothing) {
  for (const bool is_hand : {false, true}) {
    SceneBuilder b = held(kSlanted, kDrive);
    b.scene.lias[0].stiffness = {0.0};
    b.spring(0, is_hand ? b.slice(0) : b.ground(), kHoldingStiffness, 1e3);
    EXPECT_EQ(settle(b.scene, kEveryFrame).scene.lias.size(), is_hand ? 3U : 4U);
  }
}

/// Each takes away a share of what the ones before have left.
TEST(SplitTablesTest, ManyTakeNoMoreThanThereIs) {
  SceneBuilder b = held(kSlanted, {});
  for (int n = 0; n < 6; ++n) {
    b.scene.lias.push_back(b.scene.lias[1]);
  }
  const scene::Scene scene = settle(b.scene, kEveryFrame).scene;
  EXPECT_EQ(scene.lias.size(), 1U + 2U * 7U);
  EXPECT_EQ(certify(scene, kEveryFrame).verdict, Verdict::kPassive);
}

TEST(SplitTablesTest, ConstantForceMovesTheRest) {
  Player player(held({}, kConstant).scene, kEveryFrame);
  player.ticks(3000);
  const auto [low, high] = std::minmax_element(player.heard[0].begin(), player.heard[0].end());
  EXPECT_NEAR(*low, -2.0 * 5.0 / kHoldingStiffness, 1e-9);
  EXPECT_NEAR(*high, 0.0, 1e-9);
}

TEST(SplitTablesTest, EnergyIsKeptWhereNothingIsLost) {
  for (const auto& [elastic, viscous] :
       {std::pair(kSlanted, Points{}), {kSlanted, kConstant}, {kOutward, kConstant}}) {
    Player player(held(elastic, viscous, 3e-3, 1.0).scene, kEveryFrame);
    EXPECT_LT(imbalanceOf(player, 5000), 1e-12);
    EXPECT_NEAR(energiesOf(player).sections[0].dissipated, 0.0, 1e-9);
  }
}

TEST(SplitTablesTest, PlaysAsTheExplicitOneWhereTheStepIsSmall) {
  for (const auto& [elastic, viscous] : {std::pair(kSlanted, Points{}),
                                         {kSlanted, kConstant},
                                         {kSlanted, kBrake},
                                         {Points{}, kBrake},
                                         {kOutward, kBrake},
                                         {Points{}, kDrive},
                                         {kOutward, kDrive}}) {
    SceneBuilder b = held(elastic, viscous, 2e-4, 0.3, 60.0);
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
