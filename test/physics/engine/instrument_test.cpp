// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/engine/instrument.hpp"

#include <cmath>
#include <complex>
#include <cstring>

#include <gtest/gtest.h>

#include "ergotic/exception.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::Quantity;
using test::Player;
using test::SceneBuilder;

constexpr double kRate = 44100.0;
constexpr double kPi = 3.14159265358979323846;
std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Free motion of one explicit oscillator started with x[-1] = x[0] = x0 and no force in step 0.
/// x[n] = x0 Re(c lambda^n) with lambda the root of l^2 - (2 - kappa - zeta) l + (1 - zeta).
double closedForm(double kappa, double zeta, double x0, int n) {
  const double b = 2.0 - kappa - zeta;
  const std::complex<double> root =
      (b + std::sqrt(std::complex<double>(b * b - 4.0 * (1.0 - zeta)))) / 2.0;
  // x[0] = x0 and x[1] = x0 (1 - kappa): two conditions on c.
  const double real = 1.0;
  const double imag = (root.real() - (1.0 - kappa)) / root.imag();
  return x0 * (std::complex<double>(real, imag) * std::pow(root, n)).real();
}

TEST(InstrumentTest, MassOnSpringFollowsTheClosedFormOfTheScheme) {
  const double m = 0.002;
  const double k = 5000.0;
  const double z = 0.05;
  SceneBuilder b;
  const int mass = b.mass(m, 1e-3);
  b.spring(mass, b.ground(), k, z);
  b.hear(mass);
  Player player(b.scene, {kRate, 4});
  player.ticks(2000);
  for (const int n : {0, 1, 2, 100, 7999}) {
    EXPECT_NEAR(player.heard[0][at(n)],
                closedForm(k / (m * kRate * kRate), z / (m * kRate), 1e-3, n), 1e-14)
        << n;
  }
}

TEST(InstrumentTest, CellIsAMassWithItsSpringFoldedIn) {
  const double m = 0.002;
  const double k = 5000.0;
  const double z = 0.05;
  SceneBuilder b;
  const int cell = b.cell(m, k, z, 1e-3);
  b.hear(cell);
  Player player(b.scene, {kRate, 1});
  player.ticks(4000);
  const double kappa = k / (m * kRate * kRate);
  const double zeta = z / (m * kRate);
  // The cell's own spring acts in step 0 already, so it is one step ahead of the linked mass.
  for (const int n : {0, 1, 50, 3999}) {
    EXPECT_NEAR(player.heard[0][at(n)], closedForm(kappa, zeta, 1e-3, n + 1), 1e-14) << n;
  }
}

TEST(InstrumentTest, ChainModesHaveTheFrequenciesOfTheScheme) {
  const int masses = 10;
  const double m = 1e-4;
  const double k = 0.6 * m * kRate * kRate;
  for (int mode = 1; mode <= masses; ++mode) {
    SceneBuilder b;
    const int first = b.chain(masses, m, k);
    for (int i = 1; i <= masses; ++i) {
      b.scene.mats[at(first + i)].position.x() = std::sin(kPi * mode * i / (masses + 1));
    }
    b.hear(first + 1);
    Player player(b.scene, {kRate, 14});
    player.ticks(200);
    const auto& x = player.heard[0];
    const double s = std::sin(kPi * mode / (2.0 * (masses + 1)));
    const double omega = 2.0 * std::asin(std::sqrt(0.6) * s);
    // In a pure mode x[n+1] + x[n-1] = 2 cos(omega) x[n] at every n.
    double num = 0.0;
    double den = 0.0;
    for (std::size_t n = 1; n + 1 < x.size(); ++n) {
      num += x[n] * (x[n + 1] + x[n - 1]);
      den += 2.0 * x[n] * x[n];
    }
    EXPECT_NEAR(std::acos(num / den), omega, 1e-9) << "mode " << mode;
  }
}

TEST(InstrumentTest, GravityMakesAParabola) {
  SceneBuilder b;
  b.scene.sections[0].gravity.x() = -9.81;
  const int mass = b.mass(0.1, 0.0, 2.0);
  b.hear(mass);
  Player player(b.scene, {kRate, 10});
  player.ticks(1000);
  const double n = 10000.0;
  const double h = 1.0 / kRate;
  EXPECT_NEAR(player.heard[0].back(), 2.0 * n * h - 9.81 * h * h * n * (n + 1.0) / 2.0, 1e-12);
}

TEST(InstrumentTest, MomentumOfFreeMassesIsConserved) {
  SceneBuilder b;
  const int left = b.mass(0.001, 0.0, 1.0);
  const int right = b.mass(0.003, 0.01, -0.5);
  b.spring(left, right, 2000.0, 0.01);
  b.hear(left, 0, Quantity::kVelocity);
  b.hear(right, 1, Quantity::kVelocity);
  Player player(b.scene, {kRate, 14});
  player.ticks(500);
  for (std::size_t n = 0; n < player.heard[0].size(); n += 97) {
    EXPECT_NEAR(0.001 * player.heard[0][n] + 0.003 * player.heard[1][n], -0.0005, 1e-15);
  }
}

TEST(InstrumentTest, SliceForceIsAFunctionOfThePositionOfTheSameTick) {
  SceneBuilder b;
  const int slice = b.slice(0);
  b.spring(slice, b.ground(0.0, SceneBuilder::kGestural), 1234.0);
  Player player(b.scene, {kRate, 14});
  for (int n = 1; n < 100; ++n) {
    player.positions[0] = 1e-4 * n;
    player.tick();
    EXPECT_DOUBLE_EQ(player.forces[0], -1234.0 * 1e-4 * n);
  }
}

TEST(InstrumentTest, HandThatIsElsewhereAtTheStartDidNotJumpThere) {
  SceneBuilder b;
  const int slice = b.slice(0);
  b.link(LiaType::kSpringDamper, slice, b.ground(0.0, SceneBuilder::kGestural), 0.0, 10.0);
  Player player(b.scene, {kRate, 14});
  player.positions[0] = 0.02;
  player.tick();
  EXPECT_EQ(player.forces[0], 0.0);
  player.positions[0] = 0.03;
  player.tick();
  EXPECT_NEAR(player.forces[0], -10.0 * 0.01 * kRate / 14.0, 1e-9);
}

TEST(InstrumentTest, SliceOfAForeignUnitSceneGivesNewtons) {
  SceneBuilder b;
  b.scene.time_unit_s = 1.0 / 44100.0;
  const int slice = b.slice(0);
  b.spring(slice, b.ground(0.0, SceneBuilder::kGestural), 1e-6);
  Player player(b.scene, {48000.0, 16});
  player.positions[0] = 0.01;
  player.tick();
  EXPECT_NEAR(player.forces[0], -1e-6 * 44100.0 * 44100.0 * 0.01, 1e-12);
}

TEST(InstrumentTest, PerSampleSceneKeepsItsPitchAtAnotherRate) {
  SceneBuilder b;
  b.scene.time_unit_s = 1.0 / 44100.0;
  const int mass = b.mass(1.0, 1.0);
  b.spring(mass, b.ground(), 0.001);
  b.hear(mass);
  for (const double rate : {44100.0, 48000.0, 96000.0}) {
    Player player(b.scene, {rate, 10});
    player.ticks(5);
    const auto& x = player.heard[0];
    const double omega = std::acos((x[11] + x[9]) / (2.0 * x[10])) * rate;
    EXPECT_NEAR(omega, std::sqrt(0.001) * 44100.0, 0.1) << rate;
  }
}

TEST(InstrumentTest, RestOffsetsChangeNothingButTheFoldedConstants) {
  const auto hear = [](double rest) {
    SceneBuilder b;
    const int mass = b.mass(0.01, 0.5);
    const int ground = b.ground(0.2);
    const int other = b.cell(0.01, 300.0, 0.1, 0.1);
    b.spring(mass, ground, 1000.0, 0.1);
    b.link(LiaType::kContact, other, mass, 800.0, 0.02);
    for (auto& mat : b.scene.mats) {
      mat.rest.x() = rest;
    }
    b.hear(mass);
    b.hear(other, 1);
    Player player(b.scene, {kRate, 4});
    player.ticks(500);
    return player.heard;
  };
  const auto at_zero = hear(0.0);
  const auto moved = hear(0.125);
  for (std::size_t n = 0; n < at_zero[0].size(); ++n) {
    ASSERT_NEAR(at_zero[0][n], moved[0][n], 1e-12) << n;
    ASSERT_NEAR(at_zero[1][n], moved[1][n], 1e-12) << n;
  }
}

TEST(InstrumentTest, ForceOutputIsTheForceOnTheModule) {
  SceneBuilder b;
  const int mass = b.mass(1e9, 0.01);
  const int ground = b.ground();
  b.spring(mass, ground, 500.0);
  b.hear(mass, 0, Quantity::kForce);
  b.hear(ground, 1, Quantity::kForce);
  Player player(b.scene, {kRate, 4});
  player.ticks(3);
  EXPECT_NEAR(player.heard[0].back(), -5.0, 1e-9);
  EXPECT_NEAR(player.heard[1].back(), 5.0, 1e-9);
}

TEST(InstrumentTest, OutputsBetweenTwoModulesAreInterpolated) {
  SceneBuilder b;
  const int low = b.ground(1.0);
  const int high = b.ground(3.0);
  b.hear(low);
  b.scene.outputs[0].point = {low, high, 0.25};
  b.scene.outputs[0].gain = {2.0};
  Player player(b.scene, {kRate, 1});
  player.tick();
  EXPECT_DOUBLE_EQ(player.heard[0][0], 3.0);
}

TEST(InstrumentTest, DrivenPositionIsFollowedInTheSameFrame) {
  SceneBuilder b;
  const int driven = b.driven(0);
  b.hear(driven);
  b.hear(driven, 1, Quantity::kVelocity);
  Player player(b.scene, {kRate, 2});
  player.inputs = {0.25, 0.5};
  player.tick();
  EXPECT_DOUBLE_EQ(player.heard[0][0], 0.25);
  EXPECT_DOUBLE_EQ(player.heard[0][1], 0.5);
  EXPECT_DOUBLE_EQ(player.heard[1][1], 0.25 * kRate);
}

TEST(InstrumentTest, ForceInputMovesItsMassOneFrameLater) {
  SceneBuilder b;
  const int mass = b.mass(2.0);
  b.hear(mass);
  scene::Input input;
  input.mat = mass;
  b.scene.inputs.push_back(input);
  Player player(b.scene, {kRate, 2});
  player.inputs = {3.0, 0.0};
  player.tick();
  EXPECT_EQ(player.heard[0][0], 0.0);
  EXPECT_DOUBLE_EQ(player.heard[0][1], 3.0 / (2.0 * kRate * kRate));
}

TEST(InstrumentTest, StateLoadedAgainPlaysTheSameBits) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int first = b.chain(20, 1e-4, 1e5, 1e-3);
  b.link(LiaType::kContact, slice, first + 5, 2e3, 0.1);
  b.hear(first + 8);
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    Player player(b.scene, {kRate, 14}, precision);
    player.positions[0] = 0.002;
    player.ticks(100);
    std::vector<unsigned char> state(player.instrument->stateSize());
    player.instrument->saveState(state.data());
    player.ticks(100);
    Player other(b.scene, {kRate, 14}, precision);
    other.positions = player.positions;
    other.instrument->loadState(state.data());
    other.ticks(100);
    const std::size_t frames = other.heard[0].size();
    EXPECT_EQ(std::memcmp(other.heard[0].data(), player.heard[0].data() + frames,
                          frames * sizeof(double)),
              0);
    EXPECT_GT(std::abs(other.heard[0].back()), 0.0);
  }
}

TEST(InstrumentTest, StateEntriesCoverTheArenaWithoutOverlap) {
  SceneBuilder b;
  b.hear(b.mass(1.0, 1.0));
  Player player(b.scene, {kRate, 14});
  std::size_t end = 0;
  for (const StateEntry& entry : player.instrument->stateEntries()) {
    EXPECT_GE(entry.offset, end) << entry.name;
    end = entry.offset + entry.size;
  }
  EXPECT_LE(end, player.instrument->stateSize());
}

TEST(InstrumentTest, ParameterChangesOnlyWhatNamesIt) {
  SceneBuilder b;
  scene::Parameter parameter;
  parameter.name = "stiffness";
  parameter.value = 100.0;
  parameter.minimum = 50.0;
  parameter.maximum = 200.0;
  b.scene.parameters.push_back(parameter);
  const int mass = b.mass(1e9, 0.01);
  b.scene.lias[at(b.spring(mass, b.ground(), 0.0))].stiffness = {2.0, 0};
  b.hear(mass, 0, Quantity::kForce);
  Player player(b.scene, {kRate, 1});
  player.tick();
  EXPECT_NEAR(player.heard[0].back(), -2.0, 1e-9);
  auto old = player.instrument->exchange(player.instrument->prepare({150.0}));
  ASSERT_NE(old, nullptr);
  player.tick();
  EXPECT_NEAR(player.heard[0].back(), -3.0, 1e-9);
}

TEST(InstrumentTest, ParameterOutsideItsRangeIsRefusedByName) {
  SceneBuilder b;
  scene::Parameter parameter;
  parameter.name = "loss";
  parameter.maximum = 1.0;
  b.scene.parameters.push_back(parameter);
  b.mass(1.0);
  Player player(b.scene, {kRate, 1});
  try {
    player.instrument->prepare({2.0});
    FAIL() << "accepted";
  } catch (const Exception& e) {
    EXPECT_NE(std::string(e.what()).find("'loss'"), std::string::npos) << e.what();
  }
  EXPECT_THROW(player.instrument->prepare({}), Exception);
}

TEST(InstrumentTest, DisplacementsComeInTheOrderOfTheScene) {
  SceneBuilder b;
  b.ground(1.0);
  b.cell(1.0, 0.0, 0.0, 2.0);
  b.mass(1.0, 3.0);
  b.scene.mats[0].rest.x() = 1.0;
  Player player(b.scene, {kRate, 1});
  std::vector<float> x(3);
  player.instrument->readDisplacements(x.data());
  EXPECT_EQ(x, (std::vector<float>{0.0F, 2.0F, 3.0F}));
}

TEST(InstrumentTest, BlownUpModelIsSeen) {
  SceneBuilder b;
  const int mass = b.mass(1.0, 1.0);
  b.spring(mass, b.ground(), 5.0 * kRate * kRate);
  Player player(b.scene, {kRate, 14});
  EXPECT_TRUE(player.instrument->isFinite());
  player.ticks(200);
  EXPECT_FALSE(player.instrument->isFinite());
}

TEST(RatesTest, TheRatioIsTheNearestInteger) {
  scene::Scene scene;
  scene.gestural_rate_hz = 3000.0;
  EXPECT_EQ(chooseRates(scene, 44100.0).ratio, 15);
  EXPECT_EQ(chooseRates(scene, 48000.0).ratio, 16);
  EXPECT_EQ(chooseRates(scene, 44100.0, 3150.0).ratio, 14);
  EXPECT_EQ(chooseRates(scene, 44100.0, 44100.0).ratio, 1);
  scene.gestural_rate_hz = 500.0;
  EXPECT_EQ(chooseRates(scene, 44100.0).ratio, kMaxRatio)
      << "a scene's wish is met as far as can be";
  EXPECT_THROW(chooseRates(scene, 44100.0, 500.0), Exception) << "an order is not";
  EXPECT_THROW(chooseRates(scene, 44100.0, 1e9), Exception);
  EXPECT_THROW(chooseRates(scene, 1000.0), Exception);
}

TEST(RatesTest, AnIllegalDivisorIsRefusedWithTheNearestLegalOne) {
  SceneBuilder b;
  b.scene.sections[0].divisor = 5;
  try {
    chooseRates(b.scene, 44100.0, 3150.0);
    FAIL() << "accepted";
  } catch (const Exception& e) {
    EXPECT_NE(std::string(e.what()).find("nearest legal value is 7"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace ergotic::physics
