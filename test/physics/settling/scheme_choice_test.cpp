// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/scheme_choice.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "ergotic/physics/settling/settle.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::Scheme;
using test::SceneBuilder;

constexpr double kRate = 44100.0;
constexpr double kLight = 0.002;
constexpr double kHeavy = 0.008;
constexpr double kInverse = 1.0 / kLight + 1.0 / kHeavy;
const Rates kRates{kRate, 14};

/// One `auto` link between two masses.
struct Pair {
  explicit Pair(LiaType type) {
    const int a = b.mass(kLight);
    b.link(type, a, b.mass(kHeavy), 0.0);
    lia().scheme = Scheme::kAuto;
    lia().law.edit().width = {0.1};
  }
  scene::Lia& lia() { return b.scene.lias[0]; }
  Settled settled() { return settle(b.scene, kRates); }
  Scheme scheme() { return settled().scene.lias[0].scheme; }

  SceneBuilder b;
};

/// Stiffness with that h^2 K (1/Ma + 1/Mb).
scene::Value stiff(double kappa) {
  return {kappa * kRate * kRate / kInverse};
}

/// Damping with that h Z (1/Ma + 1/Mb).
scene::Value damped(double s) {
  return {s * kRate / kInverse};
}

TEST(SchemeChoiceTest, LinearContactIsGuardedAboveItsKappa) {
  Pair pair(LiaType::kContact);
  pair.lia().stiffness = stiff(0.0499);
  EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  EXPECT_TRUE(pair.settled().notes.empty());
  pair.lia().stiffness = stiff(0.0501);
  EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
  ASSERT_EQ(pair.settled().notes.size(), 1U);
  EXPECT_EQ(pair.settled().notes[0],
            "built.yaml:100:1: note: link 'l0': guarded (h^2 K (1/Ma + 1/Mb) = 0.0501, explicit "
            "bears 0.05)");
}

TEST(SchemeChoiceTest, ContactIsJudgedAtTheWorstEndOfItsRange) {
  Pair pair(LiaType::kContact);
  pair.b.scene.parameters.push_back({"k", 1.0, 0.5, 2.0, {}});
  pair.lia().stiffness = {stiff(0.0249).factor, 0};
  EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  pair.lia().stiffness = {stiff(0.0251).factor, 0};
  EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
  pair.lia().stiffness = stiff(0.0251);
  pair.b.scene.mats[0].mass = {kLight, 0};
  pair.b.scene.mats[1].mass = {kHeavy, 0};
  EXPECT_EQ(pair.scheme(), Scheme::kGuarded) << "half the masses at the lower end";
}

TEST(SchemeChoiceTest, PowerContactIsGuardedUnlessItIsLinearAndSoft) {
  Pair pair(LiaType::kPowerContact);
  pair.lia().stiffness = stiff(1e-6);
  pair.lia().law.edit().exponent = {1.0001};
  EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
  pair.lia().law.edit().exponent = {1.0};
  EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  pair.lia().stiffness = stiff(0.0501);
  EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
}

TEST(SchemeChoiceTest, NonlinearSpringsAreGuardedAsSoonAsTheyAreNonlinear) {
  for (const LiaType type : {LiaType::kQuadratic, LiaType::kCubic}) {
    Pair pair(type);
    pair.lia().stiffness = stiff(0.5);
    EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
    pair.lia().law.edit().nonlinearity = {1e-6};
    EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
    pair.lia().law.edit().nonlinearity = {-1e-6};
    EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
  }
}

TEST(SchemeChoiceTest, ClippedLawsAreJudgedByTheirSteepestSlope) {
  for (const LiaType type : {LiaType::kClippedCubic, LiaType::kCubicContact}) {
    Pair pair(type);
    pair.lia().law.edit().tipping_point = 1e-3;
    pair.lia().stiffness = stiff(0.01);
    pair.lia().law.edit().stiffness_limit = stiff(0.0499);
    EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
    pair.lia().law.edit().stiffness_limit = stiff(0.0501);
    EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
    pair.lia().law.edit().stiffness_limit = stiff(0.01);
    pair.lia().law.edit().nonlinearity = {stiff(0.0399).factor / (3.0 * 1e-6)};
    EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
    pair.lia().law.edit().nonlinearity = {stiff(0.0401).factor / (3.0 * 1e-6)};
    EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
  }
}

TEST(SchemeChoiceTest, FrictionIsGuardedWhenItRisesOrFallsTooSteeply) {
  // rise and fall of each law in units of Z; the fall decides, as it is allowed less
  const auto limit = [](LiaType type) {
    return type == LiaType::kBow ? 0.2 * 3.0 : 0.2 / (0.63 * 2.0 * std::exp(-1.0));
  };
  for (const LiaType type : {LiaType::kBow, LiaType::kSmoothBow}) {
    Pair pair(type);
    pair.lia().damping = damped(0.999 * limit(type));
    EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
    pair.lia().damping = damped(1.001 * limit(type));
    EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
  }
}

TEST(SchemeChoiceTest, SteepestFallOfTheSmoothBowIsThatOfItsCurve) {
  // F = 0.63 z v exp(-4 (v/w)^2 + 0.5) with z = w = 1
  const auto force = [](double v) { return 0.63 * v * std::exp(-4.0 * v * v + 0.5); };
  double fall = 0.0;
  for (double v = 0.0; v < 2.0; v += 1e-4) {
    fall = std::max(fall, (force(v) - force(v + 1e-4)) / 1e-4);
  }
  Pair pair(LiaType::kSmoothBow);
  pair.lia().damping = damped(0.2 / fall * 0.9999);
  EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  pair.lia().damping = damped(0.2 / fall * 1.0001);
  EXPECT_EQ(pair.scheme(), Scheme::kGuarded);
}

TEST(SchemeChoiceTest, FrictionTablesAreJudgedByTheirLines) {
  Pair pair(LiaType::kBowTable);
  const double unit = kRate / kInverse;
  const auto table = [&](double rise, double fall) {
    pair.lia().law.edit().table.points = {
        {-1.0, -rise * unit}, {1.0, rise * unit}, {2.0, (rise - fall) * unit}};
    return pair.scheme();
  };
  EXPECT_EQ(table(0.999, 0.199), Scheme::kExplicit);
  EXPECT_EQ(table(1.001, 0.199), Scheme::kGuarded);
  EXPECT_EQ(table(0.999, 0.201), Scheme::kGuarded);
}

TEST(SchemeChoiceTest, LinesOfAnElasticTableSwitchAndThoseOfAViscousOneSlide) {
  Pair elastic(LiaType::kTable);
  const auto spring = [&](double kappa) {
    const double f = stiff(kappa).factor * 1e-3;
    elastic.lia().law.edit().table.points = {{-1e-3, -0.1 * f}, {0.0, 0.0}, {1e-3, f}};
    return elastic.scheme();
  };
  EXPECT_EQ(spring(0.0499), Scheme::kExplicit);
  EXPECT_EQ(spring(0.0501), Scheme::kGuarded);
  EXPECT_EQ(spring(-0.0501), Scheme::kGuarded);
  Pair viscous(LiaType::kTable);
  const auto friction = [&](double rise, double fall) {
    const double f = kRate / kInverse;
    viscous.lia().law.edit().viscous_table.points = {
        {0.0, 0.0}, {1.0, rise * f}, {2.0, (rise - fall) * f}};
    return viscous.scheme();
  };
  EXPECT_EQ(friction(0.999, 0.199), Scheme::kExplicit);
  EXPECT_EQ(friction(1.001, 0.199), Scheme::kGuarded);
  EXPECT_EQ(friction(0.999, 0.201), Scheme::kGuarded);
}

TEST(SchemeChoiceTest, AcrossRatesOnlyWhatNoForceMovesMayBeSlow) {
  SceneBuilder b;
  const int string = b.mass(kLight);
  const auto contact = [&](int slow) {
    const int l = b.link(LiaType::kContact, slow, string, 0.06 * kLight * kRate * kRate);
    b.scene.lias[static_cast<std::size_t>(l)].scheme = Scheme::kAuto;
  };
  contact(b.slice(0));
  contact(b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural));
  contact(b.ground(0.0, SceneBuilder::kGestural));
  const Settled settled = settle(b.scene, kRates);
  EXPECT_EQ(settled.scene.lias[0].scheme, Scheme::kGuarded);
  EXPECT_EQ(settled.scene.lias[1].scheme, Scheme::kExplicit);
  EXPECT_EQ(settled.scene.lias[2].scheme, Scheme::kGuarded);
  ASSERT_EQ(settled.notes.size(), 3U);  // by place
  EXPECT_NE(settled.notes[1].find("'l1': explicit, because one end is a slower mass"),
            std::string::npos);
  const Settled at_one_rate = settle(b.scene, {kRate, 1});
  EXPECT_EQ(at_one_rate.scene.lias[1].scheme, Scheme::kGuarded);
}

TEST(SchemeChoiceTest, WallThatOnlyAHandTouchesStaysExplicit) {
  SceneBuilder b;
  const int hand = b.slice(0);
  b.link(LiaType::kPowerContact, hand, b.ground(0.0, SceneBuilder::kGestural), 1e6);
  b.scene.lias[0].scheme = Scheme::kAuto;
  b.scene.lias[0].law.edit().exponent = {2.3};
  EXPECT_EQ(settle(b.scene, kRates).scene.lias[0].scheme, Scheme::kExplicit);
}

/// One that moves may come to every module of its range; one that does not stays on its own.
TEST(SchemeChoiceTest, PointIsAsLightAsTheLightestModuleUnderIt) {
  for (const bool moves : {true, false}) {
    SceneBuilder b;
    const int first = b.chain(3, kHeavy, 1.0);
    b.scene.mats[3].mass = {kLight};
    b.scene.grids.push_back({"string", first, 5, 1});
    const int point = b.ground();
    b.scene.mats[static_cast<std::size_t>(point)].type = scene::MatType::kPoint;
    scene::Connection connection;
    connection.mat = point;
    connection.along = {0.5};
    connection.guide = moves ? b.slice(0) : -1;
    connection.guide_scale = 1.0;
    b.scene.connections.push_back(connection);
    scene::Lia& lia =
        b.scene.lias[static_cast<std::size_t>(b.link(LiaType::kContact, b.ground(), point, 0.0))];
    lia.scheme = Scheme::kAuto;
    const double mass = moves ? kLight : kHeavy;
    lia.stiffness = {0.0499 * mass * kRate * kRate};
    EXPECT_EQ(settle(b.scene, kRates).scene.lias.back().scheme, Scheme::kExplicit) << moves;
    lia.stiffness = {0.0501 * mass * kRate * kRate};
    EXPECT_EQ(settle(b.scene, kRates).scene.lias.back().scheme, Scheme::kGuarded) << moves;
  }
}

TEST(SchemeChoiceTest, LinksOfOnePlaceAreSaidOnce) {
  SceneBuilder b;
  const int bar = b.ground();
  for (int i = 0; i < 20; ++i) {
    b.link(LiaType::kContact, bar, b.mass(kLight), (0.1 + 0.01 * i) * kLight * kRate * kRate);
    b.scene.lias.back().scheme = Scheme::kAuto;
    b.scene.lias.back().place = {7, 3};
  }
  const Settled settled = settle(b.scene, kRates);
  ASSERT_EQ(settled.notes.size(), 1U);
  EXPECT_NE(settled.notes[0].find(":7:3: note: link 'l0' and 19 more: guarded"), std::string::npos);
  EXPECT_NE(settled.notes[0].find("= 0.29,"), std::string::npos) << settled.notes[0];
}

TEST(SchemeChoiceTest, WhatTheSceneSaysIsKept) {
  for (const Scheme said : {Scheme::kExplicit, Scheme::kGuarded}) {
    for (const double kappa : {0.01, 0.5}) {
      Pair pair(LiaType::kContact);
      pair.lia().stiffness = stiff(kappa);
      pair.lia().scheme = said;
      EXPECT_EQ(pair.scheme(), said);
    }
  }
}

TEST(SchemeChoiceTest, OtherLinksStayExplicit) {
  for (const LiaType type :
       {LiaType::kSpringDamper, LiaType::kPluck, LiaType::kConditional, LiaType::kTable}) {
    Pair pair(type);
    pair.lia().stiffness = stiff(0.9);
    pair.lia().damping = damped(1.5);
    EXPECT_EQ(pair.scheme(), Scheme::kExplicit);
  }
}

}  // namespace
}  // namespace ergotic::physics
