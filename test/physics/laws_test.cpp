// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using scene::Lia;
using scene::LiaType;
using test::Player;
using test::SceneBuilder;

constexpr double kRate = 44100.0;

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
    lia.width = {0.01};
  };
  EXPECT_EQ(forceOf(LiaType::kContact, set, -0.0101, 1.0), 0.0);
  EXPECT_NEAR(forceOf(LiaType::kContact, set, -0.005, 1.0), 0.5 + 3.0, 1e-9);
}

TEST(LawsTest, PolynomialSpringsAreOdd) {
  const auto set = [](Lia& lia) {
    lia.stiffness = {100.0};
    lia.nonlinearity = {5000.0};
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
    lia.stiffness_limit = {400.0};
    lia.nonlinearity = {3e6};
    lia.tipping_point = std::sqrt(300.0 / 3e6);
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
    lia.width = {0.01};
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
    lia.width = {0.3};
  };
  EXPECT_NEAR(forceOf(LiaType::kBow, set, 0.0, 0.05), 2.0 * 0.05, 1e-9);
  EXPECT_NEAR(forceOf(LiaType::kBow, set, 0.0, 0.2), 0.1 * 3.0 - 0.2, 1e-9);
  EXPECT_EQ(forceOf(LiaType::kBow, set, 0.0, 0.31), 0.0);
  EXPECT_NEAR(forceOf(LiaType::kSmoothBow, set, 0.0, -0.15),
              -0.63 * 3.0 * 0.15 * std::exp(-4.0 * 0.25 + 0.5), 1e-9);
}

TEST(LawsTest, TablesAreStraightLinesBetweenTheirPoints) {
  const auto set = [](Lia& lia) {
    lia.table.points = {{-0.2, -1.0}, {0.0, 0.0}, {0.1, 2.0}, {0.4, 0.5}};
  };
  for (const LiaType type : {LiaType::kPluck, LiaType::kBow}) {
    const auto at = [&](double value) {
      return type == LiaType::kPluck ? forceOf(type, set, value) : forceOf(type, set, 0.0, value);
    };
    EXPECT_NEAR(at(-0.1), -0.5, 1e-9);
    EXPECT_NEAR(at(0.05), 1.0, 1e-9);
    EXPECT_NEAR(at(0.2), 1.5, 1e-9);
    EXPECT_NEAR(at(0.39), 0.55, 1e-9);
    EXPECT_EQ(at(0.41), 0.0);
    EXPECT_EQ(at(-0.21), 0.0);
  }
}

}  // namespace
}  // namespace ergotic::physics
