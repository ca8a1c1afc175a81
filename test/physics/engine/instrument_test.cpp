// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/engine/instrument.hpp"

#include <complex>
#include <cstring>

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

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

TEST(InstrumentTest, RadiationIsAHighPassOfFirstOrder) {
  constexpr int kPeriod = 100;  // frames
  const double kappa = 2.0 - 2.0 * std::cos(2.0 * kPi / kPeriod);
  SceneBuilder b;
  const int cell = b.cell(1e-3, kappa * 1e-3 * kRate * kRate, 0.0, 1e-3);
  b.hear(cell, 0, Quantity::kVelocity);
  b.hear(cell, 1, Quantity::kVelocity);
  const double corner_hz = 2.0 * kRate / kPeriod;
  b.scene.outputs.back().radiation_hz = corner_hz;
  Player player(b.scene, {kRate, 1}, Precision::kDouble);
  player.ticks(20 * kPeriod);
  const auto lineOf = [&](int channel) {
    std::complex<double> line;
    for (int n = 10 * kPeriod; n < 20 * kPeriod; ++n) {
      line += player.heard[at(channel)][at(n)] * std::polar(1.0, -2.0 * kPi * n / kPeriod);
    }
    return line;
  };
  // In the bilinear rule tan(pi f h) stands for the frequency.
  const double f = std::tan(kPi / kPeriod);
  const double corner = std::tan(kPi * corner_hz / kRate);
  const std::complex<double> expected =
      std::complex<double>(0.0, f) / std::complex<double>(corner, f);
  EXPECT_LT(std::abs(lineOf(1) / lineOf(0) - expected), 1e-9);
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

TEST(InstrumentTest, StateLoadedAgainPlaysTheSameBits) {
  SceneBuilder b;
  const int slice = b.slice(0);
  const int first = b.chain(20, 1e-4, 1e5, 1e-3);
  b.link(LiaType::kContact, slice, first + 5, 2e3, 0.1);
  for (const LiaType type : {LiaType::kCubic, LiaType::kPowerContact}) {
    Lia& lia = b.scene.lias[at(b.link(type, first + 3, first + 4, 1e5))];
    lia.law.edit().nonlinearity = {1e10};
    lia.law.edit().exponent = {1.5};
    lia.scheme = Scheme::kEnergyStable;
  }
  b.hear(first + 8);
  b.hear(first + 8, 1, Quantity::kVelocity);
  b.scene.outputs.back().radiation_hz = 300.0;
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
    for (const std::size_t channel : {0U, 1U}) {
      EXPECT_EQ(std::memcmp(other.heard[channel].data(), player.heard[channel].data() + frames,
                            frames * sizeof(double)),
                0);
      EXPECT_GT(std::abs(other.heard[channel].back()), 0.0);
    }
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

TEST(InstrumentTest, ParameterOutsideItsRangeIsRefusedByName) {
  SceneBuilder b;
  b.scene.parameters.push_back({"loss", 0.0, 0.0, 1.0, {}});
  b.mass(1.0);
  Player player(b.scene, {kRate, 1});
  EXPECT_THAT(complaintOf([&] { player.instrument->prepare({2.0}); }), HasSubstr("'loss'"));
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
  EXPECT_THAT(complaintOf([&] { chooseRates(b.scene, 44100.0, 3150.0); }),
              HasSubstr("nearest legal value is 7"));
  b.scene.sections[0].divisor = 29;
  EXPECT_THAT(complaintOf([&] { chooseRates(b.scene, 44100.0, 3150.0); }),
              HasSubstr("nearest legal value is 28"));
}

}  // namespace
}  // namespace ergotic::physics
