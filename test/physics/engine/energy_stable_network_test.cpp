// SPDX-License-Identifier: BSD-3-Clause
// The energy of many energy-stable links that share masses.
#include <random>

#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A closed network that is lossless, and how long it plays; energies of unit masses and steps.
struct Closed {
  explicit Closed(const SceneBuilder& b) : player(b.scene, {kRate, 1}) {}

  void expectKept(int steps, const std::string& what) {
    player.tick();
    Energies energies = energiesOf(player);
    const double before = energies.stored;
    double worst = 0.0;
    for (int n = 1; n < steps; ++n) {
      player.tick();
      player.instrument->readEnergies(energies);
      worst = std::max(worst, std::abs(energies.stored / before - 1.0));
      for (const std::vector<double>& velocity : player.heard) {
        moving += 0.5 * velocity.back() * velocity.back() / before / steps;
      }
    }
    EXPECT_LT(worst, 1e-11) << what;
    EXPECT_LT(std::abs(energies.sections[0].dissipated), 1e-11 * before) << what;
    EXPECT_LT(std::abs(energies.residual), 1e-11 * before) << what;
  }
  double clipped() const {
    std::vector<TankReport> reports = player.instrument->makeTankReports();
    player.instrument->readTanks(reports);
    double active = 0.0;
    double clipped = 0.0;
    for (const TankReport& report : reports) {
      active += static_cast<double>(report.active);
      clipped += static_cast<double>(report.clipped);
    }
    return clipped / active;
  }

  Player player;
  double moving = 0.0;  ///< mean share of the energy that unit masses have whose speeds are heard
};

Lia& guardScaled(SceneBuilder& b, LiaType type, int from, int to, double kappa, double z = 0.0) {
  Lia& lia = b.scene.lias[at(b.link(type, from, to, kappa * kRate * kRate, z * kRate))];
  lia.scheme = Scheme::kEnergyStable;
  return lia;
}

/// A string of unit masses that lie near a barrier, all along it, plucked towards it.
SceneBuilder stringOnBarrier(double closed_kappa, double exponent) {
  constexpr int kMasses = 100;
  constexpr double kAmplitude = 1e-3;
  SceneBuilder b;
  const int first = b.chain(kMasses, 1.0, 0.9 * kRate * kRate);
  const int barrier = b.ground();
  for (int m = 1; m <= kMasses; ++m) {
    b.scene.mats[at(first + m)].position.x() = -kAmplitude * std::sin(kPi * m / (kMasses + 1.0));
    Lia& lia = guardScaled(b, LiaType::kPowerContact, first + m, barrier,
                           closed_kappa * std::pow(kAmplitude, 1.0 - exponent));
    lia.law.edit().exponent = {exponent};
    lia.law.edit().width = {-0.3 * kAmplitude};
  }
  return b;
}

TEST(EnergyStableNetworkTest, StringOnABarrierKeepsItsEnergy) {
  for (const double kappa : {0.05, 1.0, 100.0}) {
    for (const double exponent : {1.0, 1.5}) {
      Closed(stringOnBarrier(kappa, exponent))
          .expectKept(40000, std::to_string(kappa) + " " + std::to_string(exponent));
    }
  }
}

/// Cubic springs between 64 unit masses, both ends fixed, at rest in random places.
SceneBuilder cubicChain(double amplitude) {
  SceneBuilder b;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  int last = b.ground();
  for (int m = 1; m <= 65; ++m) {
    const int next = m < 65 ? b.mass(1.0, amplitude * anywhere(random)) : b.ground();
    guardScaled(b, LiaType::kCubic, last, next, 0.2).law.edit().nonlinearity = {0.05 * kRate *
                                                                                kRate};
    if (m < 65) {
      b.hear(next, m - 1, Quantity::kVelocity);
    }
    last = next;
  }
  return b;
}

/// Were each link charged for what it expects of its neighbours, it would lose nearly all; were it
/// charged for its own motion alone, it would gain 10^4 times.
TEST(EnergyStableNetworkTest, CubicChainKeepsItsEnergyAtAnyAmplitude) {
  for (const double amplitude : {0.1, 2.0, 30.0}) {
    Closed chain(cubicChain(amplitude));
    chain.expectKept(40000, std::to_string(amplitude));
    EXPECT_LT(chain.clipped(), 0.05) << amplitude;
    EXPECT_GT(chain.moving, amplitude < 10.0 ? 0.1 : 0.0) << "what the tanks hold comes back";
  }
}

TEST(EnergyStableNetworkTest, PointsThatShareMassesKeepTheEnergy) {
  constexpr int kMasses = 10;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  SceneBuilder b;
  const int ground = b.ground();
  for (int m = 1; m <= kMasses; ++m) {
    b.mass(std::pow(2.0, anywhere(random)), anywhere(random));
    b.spring(m - 1, m, 0.3 * kRate * kRate);
  }
  const int grid = b.grid(1, kMasses);
  for (int l = 0; l < 12; ++l) {
    const double place = l % (kMasses - 1) + 0.5 + 0.5 * anywhere(random);
    const int point = b.point(grid, place / (kMasses - 1));
    if (l % 2 == 0) {
      guardScaled(b, LiaType::kContact, point, ground, 3.0).law.edit().width = {-0.2};
    } else {
      guardScaled(b, LiaType::kCubic, point, ground, 0.5).law.edit().nonlinearity = {4.0 * kRate *
                                                                                     kRate};
    }
  }
  Closed(b).expectKept(20000, "");
}

/// Eight masses, between which and walls stiff links of all kinds act, several at each mass: what
/// each expects of the others is mostly wrong.
SceneBuilder crowd(std::uint32_t seed, bool is_lossy) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  std::uniform_int_distribution<int> any_mass(1, 8);
  const LiaType types[] = {LiaType::kContact,
                           LiaType::kPowerContact,
                           is_lossy ? LiaType::kFelt : LiaType::kContact,
                           LiaType::kCubic,
                           is_lossy ? LiaType::kBow : LiaType::kCubic,
                           LiaType::kContact};
  SceneBuilder b;
  const int ground = b.ground();
  for (int m = 1; m <= 8; ++m) {
    const double mass = std::pow(10.0, anywhere(random));
    const double place = anywhere(random);
    b.mass(mass, place, 0.3 * kRate * anywhere(random));
    b.spring(m - 1, m, 0.05 * kRate * kRate);
  }
  for (int l = 0; l < 16; ++l) {
    const LiaType type = types[l % 6];
    const int from = any_mass(random);
    const int other = l % 3 == 0 ? ground : any_mass(random);
    const double kappa = std::pow(10.0, 2.0 * anywhere(random));
    const bool is_friction = type == LiaType::kBow;
    const double damping = is_friction || (is_lossy && l % 2 == 0) ? 0.3 * kappa : 0.0;
    Lia& lia = guardScaled(b, type, from, other == from ? ground : other, is_friction ? 0.0 : kappa,
                           damping);
    lia.law.edit().exponent = {type == LiaType::kContact ? 1.0 : 2.0};
    lia.law.edit().width = {is_friction ? kRate : 0.5 * anywhere(random)};
    lia.law.edit().nonlinearity = {type == LiaType::kCubic ? kappa * kRate * kRate : 0.0};
  }
  return b;
}

TEST(EnergyStableNetworkTest, ManyThatShareMassesKeepTheirEnergyWhereNothingIsLossy) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Closed(crowd(seed, false)).expectKept(2000, std::to_string(seed));
  }
}

/// In the first steps what is stored, told halfway between two of them, may rise by what dampers
/// take in the other half.
TEST(EnergyStableNetworkTest, ManyThatShareMassesGiveNoMoreThanTheyHad) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Player player(crowd(seed, true).scene, {kRate, 1});
    player.tick();
    Energies energies = energiesOf(player);
    const double before = energies.stored;
    player.ticks(100);
    for (int n = 100; n < 2000; ++n) {
      player.tick();
      player.instrument->readEnergies(energies);
      ASSERT_LT(energies.stored, before) << "seed " << seed << ", step " << n;
    }
    EXPECT_LT(std::abs(energies.residual), 1e-11 * before) << seed;
  }
}

TEST(EnergyStableNetworkTest, NegativeDampersGiveNothing) {
  SceneBuilder b;
  const int mass = b.mass(1.0, 0.01);
  guardScaled(b, LiaType::kSpringDamper, mass, b.ground(), 0.1, -0.05).rest_length = 0.005;
  Closed(b).expectKept(2000, "");
}

TEST(EnergyStableNetworkTest, DampersOnSharedMassesOnlyDissipate) {
  SceneBuilder b;
  const int wall = b.ground();
  for (int m = 1; m <= 20; ++m) {
    b.mass(1.0, std::sin((m - 1) * 1.3));
    b.hear(m, 3 * m, Quantity::kVelocity);
    guardScaled(b, LiaType::kContact, m, wall, 0.8, 0.1).law.edit().width = {-0.1};
    guardScaled(b, LiaType::kCubic, m - 1, m, 0.3, 0.2).law.edit().nonlinearity = {0.2 * kRate *
                                                                                   kRate};
  }
  Player player(b.scene, {kRate, 1});
  player.tick();
  const double at_start = energiesOf(player).stored;
  double energy = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 2000; ++n) {
    const std::vector<EnergyStableState<double>> tanks = test::tankStatesOf(player);
    player.tick();
    const double now = test::energyBetweenSteps(player, tanks);
    ASSERT_LE(now, energy + 1e-14 * at_start) << n;
    ASSERT_NEAR(energiesOf(player).residual, 0.0, 1e-12 * at_start) << n;
    energy = now;
  }
  EXPECT_LT(energiesOf(player).sections[0].kinetic, 1e-3 * at_start);
}

}  // namespace
}  // namespace ergotic::physics
