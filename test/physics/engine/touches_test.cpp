// SPDX-License-Identifier: BSD-3-Clause
// Hands that hold modules while an instrument plays.
#include <cmath>
#include <complex>

#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A hand that holds a module still, `place` m from rest.
Touch holdAt(int mat, double place, double stiffness, double damping) {
  Touch touch;
  touch.mat = mat;
  touch.from = {place, 0.0, 0.0};
  touch.to = touch.from;
  touch.stiffness = stiffness;
  touch.damping = damping;
  touch.most_force = 1e9;
  return touch;
}

TEST(TouchesTest, AHeldMassSwingsAsOneOnASpringAndADamper) {
  constexpr double kMass = 0.02;
  constexpr double kStiffness = 800.0;
  constexpr double kDamping = 0.6;
  constexpr double kPlace = 0.004;
  SceneBuilder b;
  const int mass = b.mass(kMass);
  b.hear(mass);
  Player player(b.scene, kRates);
  player.touches[1] = holdAt(mass, kPlace, kStiffness, kDamping);
  player.ticks(1000);
  const double sigma = 0.5 * kDamping / kMass;
  const double omega = std::sqrt(kStiffness / kMass - sigma * sigma);
  double error = 0.0;
  for (std::size_t n = 0; n < player.heard[0].size(); ++n) {
    // The hand takes hold with the first frame, whose force moves the mass by the next one.
    const double t = static_cast<double>(n) * kStep;
    const double swing =
        std::exp(-sigma * t) * (std::cos(omega * t) + sigma / omega * std::sin(omega * t));
    error = std::max(error, std::abs(player.heard[0][n] - kPlace * (1.0 - swing)));
  }
  EXPECT_LT(error, kPlace * 0.5 * omega * kStep);  // by half a step
}

TEST(TouchesTest, AStringIsDrawnAsideAsItsStiffnessSays) {
  constexpr int kMasses = 40;
  constexpr int kHeld = 13;
  constexpr double kLink = 900.0;
  constexpr double kStiffness = 300.0;
  constexpr double kPlace = 0.003;
  SceneBuilder b;
  const int first = b.chain(kMasses, 1e-3, kLink, 0.5);
  b.hear(first + kHeld);
  Player player(b.scene, kRates);
  EXPECT_THAT(player.instrument->describe(), testing::Contains(testing::HasSubstr("a tick at")))
      << "nothing but the hand acts on it";
  player.touches[0] = holdAt(first + kHeld, kPlace, kStiffness, 2.0);
  player.ticks(4 * 3150);
  const double string = kLink / kHeld + kLink / (kMasses + 1 - kHeld);
  const double place = kStiffness * kPlace / (kStiffness + string);
  EXPECT_NEAR(player.heard[0].back(), place, 1e-9);
  EXPECT_NEAR(player.touches[0].force[0], string * place, 1e-6);
  EXPECT_EQ(player.touches[1].force[0], 0.0);
}

TEST(TouchesTest, AHandTakesHoldWhereTheModuleIs) {
  SceneBuilder b;
  const int mass = b.cell(0.01, 500.0, 0.0, 0.002);
  b.hear(mass);
  Player player(b.scene, kRates);
  player.ticks(50);
  player.touches[0] = holdAt(mass, 7.0, 100.0, 0.0);
  player.touches[0].takes_hold = true;
  const double before = player.heard[0].back();
  player.tick();
  EXPECT_EQ(player.touches[0].from[0], before);
  EXPECT_EQ(player.touches[0].to[0], before);
}

TEST(TouchesTest, AMovingTargetIsFollowedOnAStraightLine) {
  constexpr double kSpeed = 0.3;  // m/s
  SceneBuilder b;
  const int mass = b.mass(1e-3);
  b.hear(mass);
  Player player(b.scene, kRates);
  Touch& touch = player.touches[0];
  touch = holdAt(mass, 0.0, 2000.0, 1.0);
  for (int n = 0; n < 2000; ++n) {
    touch.from = touch.to;
    touch.to[0] += kSpeed * kTick;
    player.tick();
  }
  const std::vector<double>& x = player.heard[0];
  const double speed = (x.back() - x[x.size() - 100]) / (99.0 * kStep);
  EXPECT_NEAR(speed, kSpeed, 1e-9 * kSpeed);
  EXPECT_NEAR(x.back(), touch.to[0], 1e-9);
}

TEST(TouchesTest, HoldsCoordinatesOfAPlaneTogether) {
  const scene::Scene scene = scene::readYaml(
      "ergotic: 1\nsections: {a: {geometry: plane}}\n"
      "mats:\n  ball: {type: mass, mass: 0.01, at: [0.1, 0.2]}\n",
      "plane.yaml");
  Player player(scene, kRates);
  Touch& touch = player.touches[2];
  touch = holdAt(0, 0.0, 400.0, 4.0);
  touch.to = {0.03, 0.04, 0.0};
  touch.from = touch.to;
  touch.most_force = 0.1;
  player.tick();
  EXPECT_NEAR(std::hypot(touch.force[0], touch.force[1]), 0.1, 1e-12) << "not each coordinate";
  EXPECT_NEAR(touch.force[0] / touch.force[1], 0.75, 1e-9);
  touch.most_force = 100.0;
  player.ticks(3000);
  std::array<float, 2> place{};
  player.instrument->readDisplacements(place.data());
  EXPECT_NEAR(place[0], 0.03, 1e-7);
  EXPECT_NEAR(place[1], 0.04, 1e-7);
}

TEST(TouchesTest, PlacesOfBodiesThatArePlayedByTheirModesAreHeldToo) {
  SceneBuilder b;
  const std::vector<double> stiffness = {300.0, 900.0, 2500.0};
  const std::vector<double> weights = {1.0, -0.5, 0.7};
  std::vector<scene::Tap::Share> shares;
  double compliance = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    shares.push_back({b.cell(0.02, stiffness[i], 0.8), weights[i]});
    compliance += weights[i] * weights[i] / stiffness[i];
  }
  const int tap = b.tap(shares);
  b.hear(b.tap({{shares[0].mat, 1.0}}));
  Player player(b.scene, kRates);
  ASSERT_TRUE(player.instrument->canTouch(tap));
  player.touches[0] = holdAt(tap, 0.001, 700.0, 0.5);
  player.ticks(6000);
  const double force = 700.0 * 0.001 / (1.0 + 700.0 * compliance);
  EXPECT_NEAR(player.touches[0].force[0], force, 1e-9);
  EXPECT_NEAR(player.heard[0].back(), force * weights[0] / stiffness[0], 1e-12);
}

TEST(TouchesTest, PlacesOfStringsAreNotHeldWhetherTheyMoveOrStay) {
  for (const bool moves : {false, true}) {
    SceneBuilder b;
    const int first = b.chain(5, 1e-3, 100.0);
    const int place = b.point(b.grid(first, 7), 0.4);
    if (moves) {
      b.scene.connections.back().along.guide = b.slice(0);
    }
    b.spring(place, b.ground(), 10.0);
    const Player player(b.scene, kRates);
    EXPECT_TRUE(player.instrument->canTouch(first + 2));
    EXPECT_FALSE(player.instrument->canTouch(place)) << moves;
  }
}

TEST(TouchesTest, BodiesThatArePlayedByTheirModesAreHeldAnywhereOnTheirOutline) {
  const scene::Scene scene = scene::readYaml(
      "ergotic: 1\nsections: {a: {}}\ngenerators:\n"
      "  - {name: b, type: bar, as: modes, mass: 0.2, pitch: 440, ends: hinged, t60: 0.3}\n",
      "bar.yaml");
  ASSERT_EQ(scene.outlines.size(), 1U);
  const scene::Outline& outline = scene.outlines[0];
  Player player(scene, kRates);
  const auto mats = static_cast<int>(scene.mats.size());
  ASSERT_EQ(player.instrument->touchables(), mats + static_cast<int>(outline.rest.size()));
  int held = 0;
  for (std::size_t p = 0; p < outline.rest.size(); p += 7) {
    double compliance = 0.0;
    for (std::size_t j = 0; j < at(outline.modes); ++j) {
      const double weight = outline.weights[p * at(outline.modes) + j];
      compliance += weight * weight / scene.mats[at(outline.first_mat) + j].stiffness.factor;
    }
    const int place = mats + static_cast<int>(p);
    ASSERT_TRUE(player.instrument->canTouch(place));
    if (compliance < 1e-9) {
      continue;  // a hinge
    }
    player.touches[0] = holdAt(place, 1e-3, 5000.0, 20.0);
    player.ticks(3000);
    EXPECT_NEAR(player.touches[0].force[0], 5.0 / (1.0 + 5000.0 * compliance), 1e-3) << p;
    ++held;
  }
  EXPECT_GT(held, 2);
}

TEST(TouchesTest, NothingIsHeldThatDoesNotMoveByItself) {
  SceneBuilder b;
  const int first = b.chain(5, 1e-3, 900.0);
  const int slice = b.slice(0);
  const int driven = b.driven(0);
  b.spring(slice, first + 2, 10.0);
  b.spring(driven, first + 3, 10.0);
  const Player player(b.scene, kRates);
  for (int mat = first; mat <= first + 6; ++mat) {
    EXPECT_EQ(player.instrument->canTouch(mat), mat != first && mat != first + 6) << mat;
  }
  EXPECT_FALSE(player.instrument->canTouch(slice));
  EXPECT_FALSE(player.instrument->canTouch(driven));
}

/// Strings of which one goes through a tick alone and one is hung to a mass of half the rate.
scene::Scene strings() {
  SceneBuilder b;
  const int first = b.chain(24, 1e-3, 900.0, 1e-2);
  b.hear(first + 5);
  const int second = b.chain(24, 1e-3, 900.0, 1e-2);
  scene::Section slow = b.scene.sections[0];
  slow.name = "slow";
  slow.divisor = 2;
  b.scene.sections.push_back(slow);
  b.spring(second + 9, b.mass(0.01, 0.0, 0.0, 2), 200.0, 1e-2);
  b.hear(second + 4, 1);
  return b.scene;
}

TEST(TouchesTest, CountsWhatTheHandsDo) {
  SceneBuilder b;
  const int first = b.chain(24, 1e-3, 900.0, 1e-2);
  const int second = b.chain(24, 1e-3, 900.0, 1e-2);
  b.spring(second + 9, b.mass(0.01), 200.0, 1e-2);
  Player player(b.scene, kRates);
  std::mt19937 random(5);
  double stored = 0.0;
  for (int n = 0; n < 400; ++n) {
    for (std::size_t h = 0; h < 2; ++h) {
      Touch& touch = player.touches[h];
      touch.mat = n % 100 < 70 ? (h == 0 ? first : second) + 7 : Touch::kNothing;
      touch.stiffness = 500.0;
      touch.damping = 0.3;
      touch.most_force = 2.0;
      touch.from = touch.to;
      touch.to[0] = uniform(random, -0.01, 0.01);
    }
    player.tick();
    const Energies e = energiesOf(player);
    stored = std::max(stored, e.stored);
    EXPECT_NEAR(e.residual, 0.0, kUnbalanced * stored) << n;
  }
  EXPECT_GT(stored, 1e-5);
}

/// However stiff, strongly damped, and light: what a hand that stands still gives out is what its
/// spring held when it took hold, (K/4) ((x[n] - y)^2 + (x[n-1] - y)^2), and that is all.
TEST(TouchesTest, AHandThatStandsGivesOutNoMoreThanItsSpringHeld) {
  for (const double stiffness : {1e2, 1e5, 1e9}) {
    for (const double damping : {0.0, 1.0, 1e6}) {
      SceneBuilder b;
      const int first = b.chain(30, 1e-6, 900.0);
      b.scene.mats[at(first + 20)].push.edit().velocity.x() = 1.0;
      b.hear(first + 7);
      Player player(b.scene, kRates);
      player.ticks(10);
      const std::vector<double>& x = player.heard[0];
      const std::size_t taken = x.size();
      const double place = 1.01 * x.back();
      player.touches[0] = holdAt(first + 7, place, stiffness, damping);
      player.ticks(1);
      const double held =
          0.25 * stiffness * (std::pow(x[taken] - place, 2) + std::pow(x[taken - 1] - place, 2));
      const double stored = energiesOf(player).stored;
      double most = 0.0;
      for (int n = 0; n < 3000; ++n) {
        const double before = energiesOf(player).sections[0].from_inputs;
        const double force = player.touches[0].force[0];
        player.ticks(1);
        const std::size_t next = x.size() - 14;
        most = std::max(most, before + 0.5 * force * (x[next] - x[next - 1]));
      }
      EXPECT_LE(most, held + 1e-9 * (held + stored))
          << stiffness << " N/m, " << damping << " N s/m";
    }
  }
}

/// In single precision as well nothing grows.
TEST(TouchesTest, AStiffHandInSinglePrecisionIsQuiet) {
  for (const double damping : {0.0, 1.0, 1e6}) {
    SceneBuilder b;
    const int first = b.chain(30, 1e-6, 900.0);
    b.scene.mats[at(first + 20)].push.edit().velocity.x() = 1.0;
    Player player(b.scene, kRates, Precision::kFloat);
    player.ticks(10);
    const double before = kineticEnergy(player) + energiesOf(player).stored;
    player.touches[0] = holdAt(first + 7, 0.0, 1e9, damping);
    player.ticks(20000);
    EXPECT_LT(energiesOf(player).stored, 2.0 * before) << damping << " N s/m";
    EXPECT_TRUE(player.instrument->isFinite());
  }
}

/// The same where faster links pull on what is held: their forces come in all frames of its step.
TEST(TouchesTest, AHandThatHoldsWhatIsSlowerIsAsQuiet) {
  for (const int divisor : {2, 7, 14}) {
    SceneBuilder b;
    scene::Section slow = b.scene.sections[0];
    slow.name = "slow";
    slow.divisor = divisor;
    b.scene.sections.push_back(slow);
    const int held = b.mass(1e-5, 0.0, 0.0, 2);
    const int fast = b.mass(1e-3, 1e-5);
    const double step = kStep * divisor;
    b.spring(held, fast, 0.2 * 1e-5 / (step * step), 0.0);
    b.spring(b.ground(), fast, 100.0);
    b.hear(held);
    Player player(b.scene, kRates);
    player.touches[0] = holdAt(held, 0.0, 5000.0, 1.5);
    player.ticks(20000);
    double largest = 0.0;
    for (std::size_t n = player.heard[0].size() / 2; n < player.heard[0].size(); ++n) {
      largest = std::max(largest, std::abs(player.heard[0][n]));
    }
    EXPECT_LT(largest, 1e-5) << divisor;
  }
}

/// Two on one body feel each other: what one does to it the other has to count with.
TEST(TouchesTest, TwoHandsOnOneBodyGiveOutNothing) {
  SceneBuilder b;
  std::vector<scene::Tap::Share> left;
  std::vector<scene::Tap::Share> right;
  for (int j = 1; j <= 6; ++j) {
    const int mode = b.cell(1e-6, 1e-6 * std::pow(2.0 * kPi * 100.0 * j, 2), 0.0, 1e-6);
    left.push_back({mode, std::sin(j * 0.9)});
    right.push_back({mode, std::sin(j * 1.1)});
  }
  const int a = b.tap(left);
  const int c = b.tap(right);
  b.hear(a);
  Player player(b.scene, kRates);
  player.ticks(1);
  const double before = energiesOf(player).stored;
  player.touches[0] = holdAt(a, 0.0, 5000.0, 5.0);
  player.touches[1] = holdAt(c, 0.0, 5000.0, 5.0);
  player.touches[2] = holdAt(a, 0.0, 1e7, 1e3);
  player.ticks(20000);
  EXPECT_LT(kineticEnergy(player), 4.0 * before);
}

TEST(TouchesTest, WhatIsHeldDoesNotFallAsleep) {
  SceneBuilder b;
  const int mass = b.mass(0.01);
  b.scene.sections[0].sleep_energy = 1e-9;
  b.hear(mass);
  Player player(b.scene, kRates);
  player.touches[0] = holdAt(mass, 0.01, 500.0, 3.0);
  player.ticks(3000);
  const std::vector<double>& x = player.heard[0];
  for (std::size_t n = x.size() / 2; n < x.size(); ++n) {
    ASSERT_NEAR(x[n], 0.01, 1e-6) << n;
  }
}

TEST(TouchesTest, ForceStaysWithinItsLimit) {
  const scene::Scene scene = strings();
  Player player(scene, kRates, Precision::kFloat);
  std::mt19937 random(9);
  double largest = 0.0;
  for (int n = 0; n < 5000; ++n) {
    Touch& touch = player.touches[static_cast<std::size_t>(n) % kMaxTouches];
    if (n % 7 == 0) {
      touch.mat = static_cast<int>(uniform(random, 1.0, 25.0));
    }
    touch.stiffness = 1e4;
    touch.damping = 1.0;
    touch.most_force = 3.0;
    touch.from = touch.to;
    touch.to[0] = uniform(random, -1.0, 1.0);
    player.tick();
    for (const Touch& t : player.touches) {
      largest = std::max(largest, std::abs(t.force[0]));
    }
  }
  EXPECT_LE(largest, 3.0 * (1.0 + 1e-6));
  EXPECT_GT(largest, 2.99);
}

TEST(TouchesTest, WakesASectionThatSleeps) {
  SceneBuilder b;
  const int first = b.chain(20, 1e-3, 900.0, 1e-2);
  b.scene.sections[0].sleep_energy = 1e-9;
  b.hear(first + 12);
  Player player(b.scene, kRates);
  player.ticks(500);
  EXPECT_EQ(player.heard[0].back(), 0.0);
  player.touches[0] = holdAt(first + 5, 0.005, 300.0, 1.0);
  player.ticks(3000);
  EXPECT_GT(player.heard[0].back(), 5e-4);
}

/// What is played on `threads` threads, saved and loaded half way through.
std::vector<std::vector<double>> played(int threads, bool loads) {
  CompileOptions options;
  options.threads = threads;
  const scene::Scene scene = settle(strings(), kRates).scene;
  Player player(compile(scene, kRates, options));
  for (int n = 0; n < 600; ++n) {
    for (std::size_t h = 0; h < 3; ++h) {
      Touch& touch = player.touches[h];
      touch = holdAt(static_cast<int>(3 + 20 * h), 0.0, 400.0, 0.2);
      const double t = 0.01 * n * static_cast<double>(h + 1);
      touch.from[0] = 0.01 * std::sin(t);
      touch.to[0] = 0.01 * std::sin(t + 0.01 * static_cast<double>(h + 1));
    }
    player.tick();
    if (loads && n == 300) {
      std::vector<std::uint8_t> state(player.instrument->stateSize());
      player.instrument->saveState(state.data());
      player.instrument = compile(scene, kRates, options);
      player.instrument->loadState(state.data());
    }
  }
  return player.heard;
}

TEST(TouchesTest, GivesTheSameBitsOnAnyNumberOfThreadsAndFromAnyKeyframe) {
  const auto heard = played(1, false);
  EXPECT_GT(std::abs(heard[0].back()), 1e-5);
  EXPECT_GT(std::abs(heard[1].back()), 1e-5);
  EXPECT_EQ(played(2, false), heard);
  EXPECT_EQ(played(1, true), heard);
}

}  // namespace
}  // namespace ergotic::physics
