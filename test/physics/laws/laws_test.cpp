// SPDX-License-Identifier: BSD-3-Clause
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// Force on the second module of a link between a driven point at `e` moving at `v` and a ground.
double forceOf(LiaType type, const std::function<void(Lia&)>& set, double e, double v = 0.0) {
  SceneBuilder b;
  const int driven = b.driven(0);
  const int ground = b.ground();
  b.link(type, driven, ground, 0.0);
  set(b.scene.lias[0]);
  b.hear(ground, 0, scene::Quantity::kForce);
  Player player(b.scene, {kRate, 2});
  player.inputs = {e - v / kRate, e};
  player.tick();
  return player.heard[0][1];
}

/// K = 100 N/m, Z = 3 N s/m and the other numbers of its row.
struct LawRow {
  LiaType type;
  double rest;
  double width;
  double exponent;
  double e;
  double v;
  double force;
};

TEST(LawsTest, ForcesAreThoseOfTheirFormulas) {
  const double smooth = -0.63 * 3.0 * 0.15 * std::exp(-4.0 * 0.25 + 0.5);
  const LawRow rows[] = {
      {LiaType::kSpringDamper, 0.01, 0.0, 1.0, 0.02, 0.5, 1.0 + 1.5},
      {LiaType::kSpringDamper, 0.01, 0.0, 1.0, -0.02, -0.5, -3.0 - 1.5},
      {LiaType::kContact, 0.0, 0.01, 1.0, -0.0101, 1.0, 0.0},
      {LiaType::kContact, 0.0, 0.01, 1.0, -0.005, 1.0, 0.5 + 3.0},
      {LiaType::kPowerContact, 0.0, 0.02, 2.3, -0.0201, 1.0, 0.0},
      {LiaType::kPowerContact, 0.0, 0.02, 2.3, 0.01, 0.0, 100.0 * std::pow(0.03, 2.3)},
      {LiaType::kPowerContact, 0.0, 0.02, 2.3, -0.015, -0.1, 100.0 * std::pow(0.005, 2.3) - 0.3},
      // From below the plectrum is pushed down: the strongest force is at a tenth of the width.
      {LiaType::kPluck, 0.0, 0.01, 1.0, -0.0101, 0.0, 0.0},
      {LiaType::kPluck, 0.0, 0.01, 1.0, -0.001, 0.0, 0.09},
      {LiaType::kPluck, 0.0, 0.01, 1.0, -0.0005, 0.0, 0.045},
      {LiaType::kPluck, 0.0, 0.01, 1.0, 0.001, 0.0, -0.09},
      {LiaType::kPluck, 0.0, 0.01, 1.0, -0.0055, 0.0, 0.045},
      {LiaType::kBow, 0.0, 0.3, 1.0, 0.0, 0.05, 2.0 * 0.05},
      {LiaType::kBow, 0.0, 0.3, 1.0, 0.0, 0.2, 0.1 * 3.0 - 0.2},
      {LiaType::kBow, 0.0, 0.3, 1.0, 0.0, 0.31, 0.0},
      {LiaType::kSmoothBow, 0.0, 0.3, 1.0, 0.0, -0.15, smooth},
  };
  for (const LawRow& row : rows) {
    const auto set = [&row](Lia& lia) {
      lia.stiffness = {100.0};
      lia.damping = {3.0};
      lia.rest_length = row.rest;
      lia.law.edit().width = {row.width};
      lia.law.edit().exponent = {row.exponent};
    };
    EXPECT_NEAR(forceOf(row.type, set, row.e, row.v), row.force, 1e-9)
        << static_cast<int>(row.type) << " " << row.e << " " << row.v;
  }
}

/// Without damping. The clipped one is straight from 0.01 m on.
TEST(LawsTest, PolynomialSpringsAreOddAndContinuousWhereTheyEnd) {
  const auto force = [](LiaType type, double e) {
    const auto set = [](Lia& lia) {
      lia.stiffness = {100.0};
      lia.law.edit().stiffness_limit = {400.0};
      lia.law.edit().nonlinearity = {3e6};
      lia.law.edit().tipping_point = std::sqrt(300.0 / 3e6);
    };
    return forceOf(type, set, e);
  };
  for (const double sign : {1.0, -1.0}) {
    EXPECT_NEAR(force(LiaType::kQuadratic, sign * 0.02), sign * (2.0 + 1200.0), 1e-9);
    EXPECT_NEAR(force(LiaType::kCubic, sign * 0.02), sign * (2.0 + 24.0), 1e-9);
    EXPECT_NEAR(force(LiaType::kClippedCubic, sign * 0.005), sign * (0.5 + 0.375), 1e-9);
    EXPECT_NEAR(force(LiaType::kClippedCubic, sign * 0.02), sign * 8.0, 1e-9);
  }
  EXPECT_NEAR(force(LiaType::kClippedCubic, 0.0099999), force(LiaType::kClippedCubic, 0.0100001),
              1e-3);
  EXPECT_EQ(force(LiaType::kCubicContact, -0.02), 0.0);
  EXPECT_NEAR(force(LiaType::kCubicContact, 0.02), 8.0, 1e-9);
}

TEST(LawsTest, TablesAreStraightLinesBetweenTheirPoints) {
  const auto set = [](Lia& lia) {
    lia.law.edit().table.points = {{-0.2, -1.0}, {0.0, 0.0}, {0.1, 2.0}, {0.4, 0.5}};
  };
  for (const LiaType type : {LiaType::kPluckTable, LiaType::kBowTable}) {
    const auto at = [&](double value) {
      return type == LiaType::kPluckTable ? forceOf(type, set, value)
                                          : forceOf(type, set, 0.0, value);
    };
    EXPECT_NEAR(at(-0.1), -0.5, 1e-9);
    EXPECT_NEAR(at(0.05), 1.0, 1e-9);
    EXPECT_NEAR(at(0.2), 1.5, 1e-9);
    EXPECT_NEAR(at(0.39), 0.55, 1e-9);
    EXPECT_EQ(at(0.41), 0.0);
    EXPECT_EQ(at(-0.21), 0.0);
  }
}

TEST(LawsTest, ElasticAndViscousTablesAddUp) {
  const auto set = [](Lia& lia) {
    lia.rest_length = 0.05;
    lia.law.edit().table.points = {{-0.1, -2.0}, {0.0, 1.0}, {0.1, 5.0}};
    lia.law.edit().viscous_table.points = {{-1.0, -3.0}, {1.0, 1.0}};
  };
  EXPECT_NEAR(forceOf(LiaType::kTable, set, 0.10, 0.5), 3.0 + 0.0, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kTable, set, 0.0, -0.5), -0.5 - 2.0, 1e-9);
}

TEST(LawsTest, TablesOfASpringHoldTheirLastValues) {
  const auto elastic = [](Lia& lia) { lia.law.edit().table.points = {{-0.1, -2.0}, {0.1, 5.0}}; };
  EXPECT_NEAR(forceOf(LiaType::kTable, elastic, 0.3), 5.0, 1e-12);
  EXPECT_NEAR(forceOf(LiaType::kTable, elastic, -0.3), -2.0, 1e-12);
  const auto viscous = [](Lia& lia) {
    lia.law.edit().viscous_table.points = {{-1.0, -3.0}, {1.0, 1.0}};
  };
  EXPECT_NEAR(forceOf(LiaType::kTable, viscous, 0.2, 4.0), 1.0, 1e-12);
  EXPECT_NEAR(forceOf(LiaType::kTable, viscous, 0.2, -4.0), -3.0, 1e-12);
  EXPECT_NEAR(forceOf(LiaType::kTable, viscous, 0.2, 0.5), 0.0, 1e-9) << "no elastic part";
}

TEST(LawsTest, SmoothTablesAreMonotoneCubics) {
  // Slopes 1 and 7: their harmonic mean 1.75 in the middle, 0 and 10 at the ends.
  const auto elastic = [](Lia& lia) {
    lia.law.edit().table = {{{0.0, 0.0}, {1.0, 1.0}, {2.0, 8.0}}, true};
  };
  const auto viscous = [](Lia& lia) {
    lia.law.edit().viscous_table = {{{0.0, 0.0}, {1.0, 1.0}, {2.0, 8.0}}, true};
  };
  for (const auto& [at, value] : {std::pair(0.5, 0.28125), {1.0, 1.0}, {1.5, 3.46875}}) {
    EXPECT_NEAR(forceOf(LiaType::kTable, elastic, at), value, 1e-12);
    EXPECT_NEAR(forceOf(LiaType::kTable, viscous, 0.0, at), value, 1e-9);
  }
}

TEST(LawsTest, ConditionalLinkHoldsFromWhereItEngagesToWhereItLetsGo) {
  SceneBuilder b;
  const int driven = b.driven(0);
  const int ground = b.ground();
  Lia& lia =
      b.scene.lias[static_cast<std::size_t>(b.link(LiaType::kConditional, driven, ground, 100.0))];
  lia.rest_length = 1.0;
  lia.law.edit().width = {0.1};
  lia.law.edit().release = 0.3;
  b.hear(ground, 0, scene::Quantity::kForce);
  Player player(b.scene, {kRate, 9});
  player.inputs = {1.2, 1.05, 1.29, 0.71, 1.31, 1.2, 0.91, 0.69, 0.85};
  const std::vector<double> forces{0.0, 5.0, 29.0, -29.0, 0.0, 0.0, -9.0, 0.0, 0.0};
  player.tick();
  for (std::size_t n = 0; n < forces.size(); ++n) {
    EXPECT_NEAR(player.heard[0][n], forces[n], 1e-10) << n;
  }
}

/// It begins beyond what it plucks, comes back, pulls, lets go, and passes it on its way back.
TEST(LawsTest, OneWayPluckPullsOnItsWayOutOnly) {
  SceneBuilder b;
  const int driven = b.driven(0);
  const int ground = b.ground();
  Lia& lia = b.scene.lias[at(b.link(LiaType::kOneWayPluck, driven, ground, 100.0))];
  lia.rest_length = 1.0;
  lia.law.edit().width = {0.1};
  b.hear(ground, 0, scene::Quantity::kForce);
  Player player(b.scene, {kRate, 13});
  player.inputs = {1.05, 0.95, 1.05, 1.02, 1.09, 1.11, 1.09, 1.05, 0.99, 1.02, 0.8, 1.2, 1.05};
  const std::vector<double> forces{0.0, 0.0, 5.0, 2.0, 9.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0};
  player.tick();
  for (std::size_t n = 0; n < forces.size(); ++n) {
    EXPECT_NEAR(player.heard[0][n], forces[n], 1e-10) << n;
  }
}

TEST(LawsTest, ConditionalLinkIsAsHeldAsItWasWhenItsStateIsLoaded) {
  for (const scene::Scheme scheme : {scene::Scheme::kExplicit, scene::Scheme::kEnergyStable}) {
    SceneBuilder b;
    const int driven = b.driven(0);
    const int ground = b.ground();
    b.link(LiaType::kConditional, driven, ground, 100.0, 0.5);
    b.scene.lias[0].law.edit().width = {0.1};
    b.scene.lias[0].law.edit().release = 0.3;
    b.scene.lias[0].scheme = scheme;
    b.hear(ground, 0, scene::Quantity::kForce);
    Player held(b.scene, {kRate, 2});
    held.inputs = {0.05, 0.2};
    held.tick();
    std::vector<unsigned char> state(held.instrument->stateSize());
    held.instrument->saveState(state.data());
    Player other(b.scene, {kRate, 2});
    other.instrument->loadState(state.data());
    other.inputs = {0.2, 0.2};
    other.tick();
    EXPECT_NEAR(other.heard[0].back(), 20.0, 1e-10);
  }
}

/// Whether it pulls or has let go is no matter of where it is, but of where it comes from.
TEST(LawsTest, OneWayPluckGoesOnAsItWasWhenItsStateIsLoaded) {
  for (const bool has_let_go : {false, true}) {
    SceneBuilder b;
    const int driven = b.driven(0);
    const int ground = b.ground();
    b.link(LiaType::kOneWayPluck, driven, ground, 100.0);
    b.scene.lias[0].law.edit().width = {0.1};
    b.hear(ground, 0, scene::Quantity::kForce);
    Player first(b.scene, {kRate, 3});
    first.inputs = {-0.05, has_let_go ? 0.15 : 0.05, 0.05};
    first.tick();
    std::vector<unsigned char> state(first.instrument->stateSize());
    first.instrument->saveState(state.data());
    Player other(b.scene, {kRate, 3});
    other.instrument->loadState(state.data());
    other.inputs = {0.05, 0.05, 0.05};
    other.tick();
    EXPECT_NEAR(other.heard[0].back(), has_let_go ? 0.0 : 5.0, 1e-10);
  }
}

}  // namespace
}  // namespace ergotic::physics
