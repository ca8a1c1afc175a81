// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::LiaType;
using test::Player;
using test::SceneBuilder;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

double largestResidual(const scene::Scene& scene, const Rates& rates, int ticks) {
  Player player(scene, rates);
  Energies e = player.instrument->makeEnergies();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  double residual = 0.0;
  double stored = 0.0;
  for (int n = 0; n < ticks; ++n) {
    for (double& x : player.positions) {
      x += 1e-4 * noise(random);
    }
    for (double& x : player.inputs) {
      x = noise(random);
    }
    player.tick();
    if (n % 97 == 0 || n == ticks - 1) {
      player.instrument->readEnergies(e);
      residual = std::max(residual, std::abs(e.residual));
      stored = std::max(stored, std::abs(e.stored));
    }
  }
  std::printf("stored %g residual %g (relative %g) dissipated %g device %g inputs %g\n", stored,
              residual, residual / stored, e.sections[0].dissipated, e.sections[1].from_device,
              e.sections[0].from_inputs);
  for (const CouplingEnergy& c : e.couplings) {
    std::printf("  coupling %d-%d stored %g dissipated %g breathing %g\n", c.section_a, c.section_b,
                c.stored, c.dissipated, c.breathing);
  }
  return residual / stored;
}

TEST(EnergyTest, ChainBalances) {
  SceneBuilder b;
  const int first = b.chain(30, 1e-3, 1000.0, 0.01);
  b.scene.mats[at(first + 7)].position.x() = 1e-3;
  b.scene.sections[0].gravity.x() = -9.81;
  EXPECT_LT(largestResidual(b.scene, {44100.0, 14}, 10000), 1e-10);
}

TEST(EnergyTest, EveryLawBalancesAcrossRates) {
  for (const LiaType type :
       {LiaType::kSpringDamper, LiaType::kContact, LiaType::kQuadratic, LiaType::kCubic,
        LiaType::kPluck, LiaType::kBow, LiaType::kSmoothBow, LiaType::kPowerContact}) {
    SceneBuilder b;
    const int first = b.chain(30, 1e-3, 1000.0, 0.01);
    b.scene.mats[at(first + 7)].position.x() = 1e-3;
    const int hand = b.slice(0);
    const int slow = b.mass(0.1, 0.0, 0.3, SceneBuilder::kGestural);
    const int wall = b.ground(0.0, SceneBuilder::kGestural);
    b.spring(slow, wall, 500.0, 0.2);
    for (const auto& [x, y] : {std::pair(hand, first + 5), {slow, first + 9}, {first + 3, first + 11}}) {
      const int l = b.link(type, x, y, 200.0, 0.1);
      scene::Lia& lia = b.scene.lias[at(l)];
      lia.nonlinearity = {1e4};
      lia.exponent = {1.5};
      lia.width = {type == LiaType::kContact || type == LiaType::kPowerContact ? 0.0 : 0.01};
    }
    EXPECT_LT(largestResidual(b.scene, {44100.0, 14}, 10000), 1e-10) << static_cast<int>(type);
  }
}

TEST(EnergyTest, DecimatedCouplingBalances) {
  SceneBuilder b;
  const int mass = b.cell(1e-3, 0.5, 0.001, 1e-3);
  const int slow = b.mass(0.1, 0.0, 0.3, SceneBuilder::kGestural);
  const int l = b.spring(slow, mass, 2.0, 0.0001);
  b.scene.lias[at(l)].coupling = scene::Coupling::kDecimate;
  EXPECT_LT(largestResidual(b.scene, {44100.0, 14}, 20000), 1e-10);
}

TEST(EnergyTest, SpaceBalances) {
  SceneBuilder b;
  b.scene.sections[0].geometry = Geometry::kSpace;
  b.scene.sections[0].medium = {1e-4};
  b.scene.sections[0].gravity = {0.0, 1.0, -9.0};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  std::vector<int> m;
  for (int i = 0; i < 12; ++i) {
    m.push_back(b.mass(1e-3));
    scene::Mat& mat = b.scene.mats.back();
    mat.rest = {noise(random), noise(random), noise(random)};
    mat.position = mat.rest + 0.01 * Eigen::Vector3d::Random();
  }
  m.push_back(b.ground());
  for (int i = 0; i < 13; ++i) {
    for (int j = 0; j < i; ++j) {
      const int l = b.link(i % 3 == 0 ? LiaType::kCubic : LiaType::kSpringDamper, m[at(i)], m[at(j)],
                           20.0, 0.001);
      b.scene.lias[at(l)].nonlinearity = {100.0};
      b.scene.lias[at(l)].rest_length =
          (b.scene.mats[at(m[at(i)])].rest - b.scene.mats[at(m[at(j)])].rest).norm();
    }
  }
  const int slow = b.mass(0.1, 0.0, 0.3, SceneBuilder::kGestural);
  b.spring(slow, m[3], 10.0, 0.001);
  b.spring(slow, m[7], 10.0, 0.001);
  EXPECT_LT(largestResidual(b.scene, {44100.0, 14}, 5000), 1e-10);
}

TEST(EnergyTest, MovingPlaceBalances) {
  SceneBuilder b;
  const int first = b.chain(30, 1e-3, 1000.0, 0.01);
  b.scene.mats[at(first + 7)].position.x() = 1e-3;
  b.scene.grids.push_back({"s", first, 32, 1});
  scene::Mat point;
  point.name = "finger";
  point.type = scene::MatType::kPoint;
  b.scene.mats.push_back(point);
  const int finger = static_cast<int>(b.scene.mats.size()) - 1;
  scene::Connection c;
  c.mat = finger;
  c.grid = 0;
  c.along = {0.1};
  const int hand = b.slice(0);
  c.guide = hand;
  c.guide_scale = 300.0;
  c.along_maximum = 0.9;
  b.scene.connections.push_back(c);
  b.spring(b.ground(), finger, 300.0, 0.1);
  b.spring(hand, finger, 30.0, 0.1);
  EXPECT_LT(largestResidual(b.scene, {44100.0, 14}, 5000), 1e-10);
}

}  // namespace
}  // namespace ergotic::physics
