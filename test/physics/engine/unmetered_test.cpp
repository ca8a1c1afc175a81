// SPDX-License-Identifier: BSD-3-Clause
// Without energy accounts an instrument plays the same, and knows what positions alone tell.
#include <cstring>

#include "support/physics.hpp"
#include "support/random_scene.hpp"

namespace ergotic::physics {
namespace {

constexpr unsigned kComparedScenes = 60;

Player playerOf(const scene::Scene& scene,
                const Rates& rates,
                bool metered,
                Precision precision,
                rt::Isa isa = rt::bestIsa()) {
  CompileOptions options(precision);
  options.metered = metered;
  options.isa = isa;
  return Player(compile(settle(scene, rates).scene, rates, options));
}

/// Positions, steps and forces of all slots.
std::string motionOf(const Instrument& instrument) {
  std::vector<char> state(instrument.stateSize());
  instrument.saveState(state.data());
  std::string motion;
  for (const StateEntry& entry : instrument.stateEntries()) {
    if (entry.name == "x" || entry.name == "d" || entry.name == "f") {
      motion.append(state.data() + entry.offset, entry.size);
    }
  }
  return motion;
}

/// Plays both with the same hands and inputs, and expects the same bits.
void expectSameMotion(Player& one, Player& other, int ticks) {
  for (int n = 0; n < ticks; ++n) {
    for (Player* player : {&one, &other}) {
      for (double& x : player->positions) {
        x = 1e-3 * std::sin(0.02 * n);
      }
      for (double& x : player->inputs) {
        x = std::sin(0.3 * n);
      }
      player->tick();
    }
    const std::size_t bytes = one.forces.size() * sizeof(double);
    ASSERT_TRUE(bytes == 0 || std::memcmp(one.forces.data(), other.forces.data(), bytes) == 0)
        << "tick " << n;
  }
  EXPECT_TRUE(motionOf(*one.instrument) == motionOf(*other.instrument));
  EXPECT_EQ(one.heard, other.heard);
}

/// A net that hangs in the plane or in space, on rows of its own and on links across them, over
/// stops that some of it lies on, with gravity.
SceneBuilder attachedNet(Geometry geometry) {
  constexpr int kRows = 7;
  constexpr int kColumns = 21;
  SceneBuilder b;
  b.scene.sections[0].geometry = geometry;
  b.scene.sections[0].gravity.x() = -9.81;
  for (int i = 0; i < kRows * kColumns; ++i) {
    const bool is_edge = i < kColumns || i >= (kRows - 1) * kColumns;
    const int mat = is_edge ? b.ground() : b.mass(1e-3, 1e-4 * std::sin(1.7 * i));
    b.scene.mats.back().rest = {0.01 * (i / kColumns), 0.01 * (i % kColumns), 0.0};
    b.scene.mats.back().position += b.scene.mats.back().rest;
    if (i % kColumns > 0) {
      b.spring(mat - 1, mat, 300.0, 1e-3);
      b.scene.lias.back().rest_length = 0.008;
    }
    if (i >= kColumns) {
      b.spring(mat, mat - kColumns, 300.0, 1e-3);
    }
    if (i % 5 == 0 && i >= kColumns) {
      b.link(LiaType::kContact, mat, (i * 7) % kColumns, 200.0, 1e-3);
      b.scene.lias.back().law.edit().width = {0.02};
    }
  }
  b.hear(kColumns + 1);
  return b;
}

class UnmeteredTest : public testing::TestWithParam<Precision> {};

TEST_P(UnmeteredTest, RandomScenesMoveBitForBitAsWithEnergies) {
  for (unsigned seed = 0; seed < kComparedScenes; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const test::RandomScene random = test::randomScene(seed);
    Player with = playerOf(random.scene, random.rates, true, GetParam());
    Player without = playerOf(random.scene, random.rates, false, GetParam());
    expectSameMotion(with, without, 150);
    EXPECT_LT(without.instrument->stateSize(), with.instrument->stateSize());
  }
}

TEST_P(UnmeteredTest, NetsMoveBitForBitAsWithEnergiesAndOnEveryLevel) {
  for (const Geometry geometry : {Geometry::kLine, Geometry::kPlane, Geometry::kSpace}) {
    SceneBuilder b = attachedNet(geometry);
    const Rates rates{kRate, 7};
    for (const rt::Isa isa : {rt::Isa::kBaseline, rt::Isa::kAvx2, rt::Isa::kAvx512}) {
      if (isa > rt::bestIsa()) {
        continue;
      }
      Player with = playerOf(b.scene, rates, true, GetParam());
      Player without = playerOf(b.scene, rates, false, GetParam(), isa);
      expectSameMotion(with, without, 200);
      EXPECT_TRUE(with.instrument->isFinite());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Precisions,
                         UnmeteredTest,
                         testing::Values(Precision::kFloat, Precision::kDouble));

TEST(UnmeteredEnergyTest, PositionsTellKineticEnergyGravityAndSprings) {
  for (const Geometry geometry : {Geometry::kScalar, Geometry::kSpace}) {
    SceneBuilder b;
    b.scene.sections[0].geometry = geometry;
    b.scene.sections[0].gravity.x() = -9.81;
    const int ground = b.ground();
    const int mass = b.mass(0.01, 0.02, 0.5);
    b.spring(mass, ground, 50.0, 1e-3);
    b.scene.lias.back().rest_length = geometry == Geometry::kScalar ? 0.0 : 0.015;
    Player with = playerOf(b.scene, Rates{kRate, 4}, true, Precision::kDouble);
    Player without = playerOf(b.scene, Rates{kRate, 4}, false, Precision::kDouble);
    with.ticks(20);
    without.ticks(20);
    const Energies counted = energiesOf(with);
    const Energies told = energiesOf(without);
    EXPECT_EQ(told.sections[0].kinetic, counted.sections[0].kinetic);
    // In space the energy accounts begin with half the work of the first step.
    EXPECT_NEAR(told.sections[0].potential, counted.sections[0].potential,
                geometry == Geometry::kScalar ? 0.0 : 1e-3 * counted.sections[0].potential);
    EXPECT_GT(counted.sections[0].dissipated, 0.0);
    EXPECT_EQ(told.sections[0].dissipated, 0.0);
    EXPECT_EQ(told.stored, told.sections[0].kinetic + told.sections[0].potential);
    EXPECT_EQ(told.residual, 0.0);
  }
}

TEST(UnmeteredEnergyTest, NothingElseIsKnown) {
  for (unsigned seed = 0; seed < kComparedScenes; ++seed) {
    const test::RandomScene random = test::randomScene(seed);
    Player player = playerOf(random.scene, random.rates, false, Precision::kDouble);
    player.ticks(30);
    const Energies energies = energiesOf(player);
    EXPECT_EQ(energies.residual, 0.0);
    EXPECT_EQ(energies.from_parameters, 0.0);
    for (const SectionEnergy& s : energies.sections) {
      EXPECT_EQ(std::abs(s.dissipated) + std::abs(s.from_device) + std::abs(s.from_inputs) +
                    std::abs(s.from_links),
                0.0);
    }
    for (const CouplingEnergy& c : energies.couplings) {
      EXPECT_EQ(std::abs(c.stored) + std::abs(c.dissipated) + std::abs(c.made), 0.0);
    }
  }
}

TEST(UnmeteredEnergyTest, QuietSectionsStillSleep) {
  SceneBuilder b;
  b.scene.sections[0].sleep_energy = 1e-6;
  const int first = b.chain(5, 1e-3, 100.0, 0.01);
  setVelocity(b.scene.mats[at(first + 3)], {0.1, 0.0, 0.0});
  Player player = playerOf(b.scene, Rates{kRate, 1}, false, Precision::kDouble);
  player.ticks(64);
  EXPECT_GT(energiesOf(player).stored, 0.0);
  player.ticks(40000);
  EXPECT_EQ(energiesOf(player).stored, 0.0);
}

TEST(UnmeteredEnergyTest, ThreadsBeyondTheRangeAreRefused) {
  SceneBuilder b;
  b.chain(3, 1e-3, 100.0);
  const Rates rates{kRate, 1};
  const scene::Scene settled = settle(b.scene, rates).scene;
  for (const int threads : {-1, 0, kMaxThreads + 1}) {
    CompileOptions options;
    options.threads = threads;
    EXPECT_THAT(complaintOf([&] { compile(settled, rates, options); }),
                HasSubstr(std::to_string(threads) + ", allowed: 1...8"));
  }
}

}  // namespace
}  // namespace ergotic::physics
