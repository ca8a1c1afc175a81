// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "physics/settling/steps.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kStiffness = 1000.0;
constexpr double kRest = 0.06;

/// A mass at 0.1 m from a ground, on an energy-stable spring that wants to be 0.06 m long.
SceneBuilder stretched() {
  SceneBuilder b;
  b.scene.sections[0].geometry = scene::Geometry::kSpace;
  const int mass = b.mass(0.01);
  b.spring(mass, b.ground(), kStiffness, 0.5);
  b.scene.mats[at(mass)].rest = b.scene.mats[at(mass)].position = {0.06, 0.08, 0.0};
  b.scene.lias[0].rest_length = kRest;
  b.scene.lias[0].scheme = Scheme::kEnergyStable;
  return b;
}

TEST(SplitSpringsTest, BothPartsTogetherAreTheSpring) {
  scene::Scene scene = stretched().scene;
  splitSprings(scene);
  ASSERT_EQ(scene.lias.size(), 2U);
  const scene::Lia& energy_stable = scene.lias[0];
  const scene::Lia& tension = scene.lias[1];
  EXPECT_EQ(tension.name.str(), "l0.tension");
  EXPECT_EQ(tension.scheme, Scheme::kExplicit);
  EXPECT_EQ(tension.damping.factor, 0.0);
  EXPECT_EQ(energy_stable.scheme, Scheme::kEnergyStable);
  EXPECT_EQ(energy_stable.damping.factor, 0.5);
  EXPECT_DOUBLE_EQ(energy_stable.rest_length, 0.1) << "it pushes nothing where the mass rests";
  for (const double length : {0.01, 0.1, 0.3}) {
    EXPECT_NEAR(energy_stable.stiffness.factor * (length - energy_stable.rest_length) +
                    tension.stiffness.factor * length,
                kStiffness * (length - kRest), 1e-9);
  }
}

TEST(SplitSpringsTest, WhatIsNotStretchedOrNotEnergyStableStays) {
  const auto splits = [](auto&& change) {
    SceneBuilder b = stretched();
    change(b.scene);
    splitSprings(b.scene);
    return b.scene.lias.size() > 1;
  };
  EXPECT_TRUE(splits([](scene::Scene&) {}));
  EXPECT_FALSE(splits([](scene::Scene& s) { s.lias[0].scheme = Scheme::kExplicit; }));
  EXPECT_FALSE(splits([](scene::Scene& s) { s.lias[0].rest_length = 0.1; }));
  EXPECT_FALSE(splits([](scene::Scene& s) { s.lias[0].rest_length = 0.2; }));
  EXPECT_FALSE(splits([](scene::Scene& s) { s.sections[0].geometry = scene::Geometry::kScalar; }));
  EXPECT_FALSE(splits([](scene::Scene& s) { s.lias[0].type = LiaType::kContact; }));
}

/// What is thrown about far beyond its length loses nothing and gains nothing.
TEST(SplitSpringsTest, NetThatIsThrownAboutKeepsItsEnergy) {
  SceneBuilder b;
  b.scene.sections[0].geometry = scene::Geometry::kSpace;
  const int first = b.chain(12, 0.01, 0.9 * 0.01 * kRate * kRate);
  for (int i = 0; i <= 13; ++i) {
    scene::Mat& mat = b.scene.mats[at(first + i)];
    mat.rest.x() = 0.1 * i;
    mat.position = mat.rest;
    scene::setVelocity(mat, {3.0 * std::sin(i), 200.0 * std::sin(2.0 * i), 200.0 * std::cos(i)});
  }
  for (scene::Lia& lia : b.scene.lias) {
    lia.rest_length = 0.07;
    lia.scheme = Scheme::kAuto;
  }
  const scene::Scene settled = settle(b.scene, {kRate, 14}).scene;
  ASSERT_EQ(certify(settled, {kRate, 14}).verdict, Verdict::kPassive);
  Player player(compile(settled, {kRate, 14}, Precision::kDouble));
  Energies energies = player.instrument->makeEnergies();
  const auto motion = [&] {
    player.instrument->readEnergies(energies);
    return energies.sections[0].kinetic;
  };
  player.tick();
  player.instrument->readEnergies(energies);
  const double start = energies.sections[0].kinetic + energies.stored;
  for (int n = 0; n < 20000; ++n) {
    player.tick();
    ASSERT_LE(motion(), start * (1.0 + 1e-9)) << n;
  }
}

}  // namespace
}  // namespace ergotic::physics
