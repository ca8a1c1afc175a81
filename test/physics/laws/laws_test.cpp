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

TEST(LawsTest, SpringDamperIsLinear) {
  const auto set = [](Lia& lia) {
    lia.stiffness = {100.0};
    lia.damping = {3.0};
    lia.rest_length = 0.01;
  };
  EXPECT_NEAR(forceOf(LiaType::kSpringDamper, set, 0.02, 0.5), 100.0 * 0.01 + 3.0 * 0.5, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kSpringDamper, set, -0.02, -0.5), -3.0 - 1.5, 1e-9);
}

TEST(LawsTest, ContactPushesOnlyBeyondItsThreshold) {
  const auto set = [](Lia& lia) {
    lia.stiffness = {100.0};
    lia.damping = {3.0};
    lia.law.edit().width = {0.01};
  };
  EXPECT_EQ(forceOf(LiaType::kContact, set, -0.0101, 1.0), 0.0);
  EXPECT_NEAR(forceOf(LiaType::kContact, set, -0.005, 1.0), 0.5 + 3.0, 1e-9);
}

TEST(LawsTest, PolynomialSpringsAreOdd) {
  const auto set = [](Lia& lia) {
    lia.stiffness = {100.0};
    lia.law.edit().nonlinearity = {5000.0};
  };
  for (const double e : {0.02, -0.02}) {
    const double sign = e > 0.0 ? 1.0 : -1.0;
    EXPECT_NEAR(forceOf(LiaType::kQuadratic, set, e), sign * (2.0 + 2.0), 1e-9);
    EXPECT_NEAR(forceOf(LiaType::kCubic, set, e), sign * (2.0 + 0.04), 1e-9);
  }
}

TEST(LawsTest, ClippedCubicIsContinuousWhereItsStiffnessEnds) {
  const auto set = [](Lia& lia) {
    lia.stiffness = {100.0};
    lia.law.edit().stiffness_limit = {400.0};
    lia.law.edit().nonlinearity = {3e6};
    lia.law.edit().tipping_point = std::sqrt(300.0 / 3e6);
  };
  EXPECT_NEAR(forceOf(LiaType::kClippedCubic, set, 0.005), 0.5 + 0.375, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kClippedCubic, set, 0.02), 8.0, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kClippedCubic, set, 0.0099999),
              forceOf(LiaType::kClippedCubic, set, 0.0100001), 1e-3);
  EXPECT_EQ(forceOf(LiaType::kCubicContact, set, -0.02), 0.0);
  EXPECT_NEAR(forceOf(LiaType::kCubicContact, set, 0.02), 8.0, 1e-9);
}

TEST(LawsTest, PluckPushesBackUntilItSlips) {
  const auto set = [](Lia& lia) {
    lia.stiffness = {1000.0};
    lia.law.edit().width = {0.01};
  };
  // From below the plectrum is pushed down: the strongest force is at a tenth of the width.
  EXPECT_EQ(forceOf(LiaType::kPluck, set, -0.0101), 0.0);
  EXPECT_NEAR(forceOf(LiaType::kPluck, set, -0.001), 0.9, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kPluck, set, -0.0005), 0.45, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kPluck, set, 0.001), -0.9, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kPluck, set, -0.0055), 0.45, 1e-9);
}

TEST(LawsTest, BowsDragWithTheirCurve) {
  const auto set = [](Lia& lia) {
    lia.damping = {3.0};
    lia.law.edit().width = {0.3};
  };
  EXPECT_NEAR(forceOf(LiaType::kBow, set, 0.0, 0.05), 2.0 * 0.05, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kBow, set, 0.0, 0.2), 0.1 * 3.0 - 0.2, 1e-9);
  EXPECT_EQ(forceOf(LiaType::kBow, set, 0.0, 0.31), 0.0);
  EXPECT_NEAR(forceOf(LiaType::kSmoothBow, set, 0.0, -0.15),
              -0.63 * 3.0 * 0.15 * std::exp(-4.0 * 0.25 + 0.5), 1e-9);
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

TEST(LawsTest, PowerContactPushesWithItsExponentBeyondItsThreshold) {
  const auto set = [](Lia& lia) {
    lia.stiffness = {1000.0};
    lia.damping = {3.0};
    lia.law.edit().width = {0.02};
    lia.law.edit().exponent = {2.3};
  };
  EXPECT_EQ(forceOf(LiaType::kPowerContact, set, -0.0201, 1.0), 0.0);
  EXPECT_NEAR(forceOf(LiaType::kPowerContact, set, 0.01), 1000.0 * std::pow(0.03, 2.3), 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kPowerContact, set, -0.015, -0.5),
              1000.0 * std::pow(0.005, 2.3) - 1.5, 1e-9);
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

TEST(LawsTest, ConditionalLinkIsAsHeldAsItWasWhenItsStateIsLoaded) {
  SceneBuilder b;
  const int driven = b.driven(0);
  const int ground = b.ground();
  b.link(LiaType::kConditional, driven, ground, 100.0, 0.5);
  b.scene.lias[0].law.edit().width = {0.1};
  b.scene.lias[0].law.edit().release = 0.3;
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

}  // namespace
}  // namespace ergotic::physics
