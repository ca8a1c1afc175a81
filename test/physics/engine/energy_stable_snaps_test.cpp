// SPDX-License-Identifier: BSD-3-Clause
// Energy-stable links that hold on to what comes near and let go of what leaves.
#include <cmath>

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kEngage = 0.01;  // m

/// A link to the ground that engages within 1 cm, with h^2 K/M = kappa. What moves is heard on the
/// channels that energyBetweenSteps() reads.
scene::Lia& snap(SceneBuilder& b, int mass, double kappa, double release, Scheme scheme) {
  scene::Lia& lia = b.scene.lias[at(b.link(LiaType::kConditional, mass, b.ground(),
                                           kappa * kEveryFrame.audio_hz * kEveryFrame.audio_hz))];
  lia.law.edit().width = {kEngage};
  lia.law.edit().release = release;
  lia.scheme = scheme;
  return lia;
}

double speedAfter(double kappa, double release, double v, double damping, Scheme scheme) {
  SceneBuilder b;
  const int mass = b.mass(1.0, -1.5 * kEngage, v);
  snap(b, mass, kappa, release, scheme).damping = {damping};
  b.hear(mass, 0, Quantity::kVelocity);
  Player player(compile(b.scene, kEveryFrame, Precision::kDouble));
  player.ticks(70000);
  return player.heard[0].back();
}

/// It comes in with K engage^2/2 more and leaves with K release^2/2 less.
TEST(EnergyStableSnapsTest, WhatIsTornOffHasLostWhatTheLinkHeldBeyond) {
  const double kappa = 1e-6;
  const double k = kappa * kRate * kRate;
  for (const Scheme scheme : {Scheme::kExplicit, Scheme::kEnergyStable}) {
    for (const double release : {1.0 * kEngage, 1.2 * kEngage}) {
      const double slower = k * (release * release - kEngage * kEngage);
      EXPECT_NEAR(speedAfter(kappa, release, 1.0, 0.0, scheme), std::sqrt(1.0 - slower), 2e-3);
    }
  }
}

/// A ball that is thrown through a one-way pluck, and back again, loses K width^2/2 on its way out
/// and nothing on its way back. If it is too slow it is thrown back without loss.
TEST(EnergyStableSnapsTest, OneWayPluckTakesOnTheWayOutOnly) {
  const double kappa = 1e-6;
  const double k = kappa * kRate * kRate;
  const double slowest = kEngage * std::sqrt(k);
  for (const Scheme scheme : {Scheme::kExplicit, Scheme::kEnergyStable}) {
    for (const double v : {0.9 * slowest, 1.1 * slowest, 2.0 * slowest, -2.0 * slowest}) {
      SceneBuilder b;
      const int mass = b.mass(1.0, v > 0.0 ? -1.5 * kEngage : 1.5 * kEngage, v);
      scene::Lia& lia = b.scene.lias[at(b.link(LiaType::kOneWayPluck, mass, b.ground(), k))];
      lia.law.edit().width = {kEngage};
      lia.scheme = scheme;
      b.hear(mass, 0, Quantity::kVelocity);
      Player player(compile(b.scene, kEveryFrame, Precision::kDouble));
      player.ticks(70000);
      const double left = v * v - slowest * slowest;
      const double expected = v < 0.0 ? v : left > 0.0 ? std::sqrt(left) : -v;
      EXPECT_NEAR(player.heard[0].back(), expected, 2e-3 * slowest) << v / slowest;
    }
  }
}

TEST(EnergyStableSnapsTest, PlaysAsTheExplicitOneWhereThatIsFine) {
  for (const double damping : {0.0, 3.0}) {
    const double plain = speedAfter(1e-7, 2.0 * kEngage, 1.0, damping, Scheme::kExplicit);
    EXPECT_NEAR(speedAfter(1e-7, 2.0 * kEngage, 1.0, damping, Scheme::kEnergyStable), plain, 2e-4);
  }
}

TEST(EnergyStableSnapsTest, WhatIsCaughtSwingsAsOnASpring) {
  const double w = 0.01;  // rad per sample
  SceneBuilder b;
  const int mass = b.mass(1.0, 0.0, 0.9 * kEngage * w * kRate);
  snap(b, mass, 4.0 * std::pow(std::sin(w / 2.0), 2), kEngage, Scheme::kEnergyStable);
  b.hear(mass);
  Player player(compile(b.scene, kEveryFrame, Precision::kDouble));
  player.ticks(7000);
  const double amplitude = 0.9 * kEngage * w / std::sin(w);  // through 0 and one step before
  for (std::size_t n = 0; n < player.heard[0].size(); ++n) {
    ASSERT_NEAR(player.heard[0][n], amplitude * std::sin(w * static_cast<double>(n + 1)),
                1e-3 * amplitude);
  }
}

/// A ball that a cubic spring brings back again and again through a link that snaps.
SceneBuilder swinging(double kappa, double release) {
  SceneBuilder b;
  const int mass = b.mass(1.0, 3.0 * kEngage, 1.0);
  b.hear(mass, 3 * mass, Quantity::kVelocity);
  snap(b, mass, kappa, release, Scheme::kEnergyStable);
  scene::Lia& spring = b.scene.lias[at(b.link(LiaType::kCubic, mass, b.ground(), 1e4))];
  spring.law.edit().nonlinearity = {1e7};
  spring.scheme = Scheme::kEnergyStable;
  return b;
}

TEST(EnergyStableSnapsTest, EnergyIsKeptWhereItLetsGoWhereItEngages) {
  for (const double kappa : {1e-6, 1e-3, 3.0}) {
    Player player(compile(swinging(kappa, kEngage).scene, kEveryFrame, Precision::kDouble));
    player.tick();
    auto tanks = test::tankStatesOf(player);
    player.tick();
    const double start = test::energyBetweenSteps(player, tanks);
    int passes = 0;
    for (int n = 0; n < 20000; ++n) {
      tanks = test::tankStatesOf(player);
      player.tick();
      ASSERT_NEAR(test::energyBetweenSteps(player, tanks), start, 1e-12 * start) << n;
      const bool holds = test::tankStatesOf(player)[0].phase != 0.0;
      passes += holds != (tanks[0].phase != 0.0) ? 1 : 0;
    }
    EXPECT_GT(passes, 20) << kappa;
    EXPECT_NEAR(test::heatOf(tanks), 0.0, 1e-12);
  }
}

TEST(EnergyStableSnapsTest, EnergyOnlyFallsWhereItLetsGoLater) {
  for (const double kappa : {1e-7, 1e-6, 1e-5}) {
    Player player(compile(swinging(kappa, 1.5 * kEngage).scene, kEveryFrame, Precision::kDouble));
    player.ticks(2);
    double last = std::numeric_limits<double>::infinity();
    for (int n = 0; n < 20000; ++n) {
      const auto tanks = test::tankStatesOf(player);
      player.tick();
      const double now = test::energyBetweenSteps(player, tanks);
      ASSERT_LE(now, last * (1.0 + 1e-12)) << n;
      last = now;
    }
    EXPECT_GT(test::heatOf(test::tankStatesOf(player)), 0.1);
  }
}

TEST(EnergyStableSnapsTest, EnergyOnlyFallsByAOneWayPluck) {
  for (const double kappa : {1e-7, 1e-5, 0.1, 3.0}) {
    for (const double damping : {0.0, 5.0}) {
      SceneBuilder b = swinging(kappa, kEngage);
      scene::Lia& pluck = b.scene.lias.front();
      pluck.type = LiaType::kOneWayPluck;
      pluck.damping = {damping};
      Player player(compile(b.scene, kEveryFrame, Precision::kDouble));
      player.ticks(2);
      const double start = test::energyBetweenSteps(player, test::tankStatesOf(player));
      double last = std::numeric_limits<double>::infinity();
      for (int n = 0; n < 20000; ++n) {
        const auto tanks = test::tankStatesOf(player);
        player.tick();
        const double now = test::energyBetweenSteps(player, tanks);
        ASSERT_LE(now, last + 1e-12 * start) << n;
        last = now;
      }
      if (kappa < 0.01) {  // stiffer ones throw it back
        EXPECT_GT(test::heatOf(test::tankStatesOf(player)), 0.0) << kappa;
      }
    }
  }
}

TEST(EnergyStableSnapsTest, RestsAnywhere) {
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    const bool is_double = precision == Precision::kDouble;
    for (const double engage : {is_double ? 1e300 : 1e30, 1.0, 1e-30, is_double ? 1e-310 : 1e-40}) {
      for (const double x : {0.0, engage, -engage, engage / 2.0}) {
        SceneBuilder b;
        const int mass = b.mass(1.0, x);
        scene::Lia& lia = snap(b, mass, 0.1, 2.0 * engage, Scheme::kEnergyStable);
        lia.law.edit().width = {engage};
        lia.stiffness = {engage > 1.0 ? 1e-300 : 1e6};
        lia.damping = {1.0};
        b.hear(mass);
        Player player(compile(b.scene, kEveryFrame, precision));
        player.ticks(100);
        EXPECT_TRUE(player.instrument->isFinite()) << x;
        EXPECT_LE(std::abs(player.heard[0].back()), engage * (1.0 + 1e-6)) << x;
      }
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
