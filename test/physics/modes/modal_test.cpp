// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include "ergotic/physics/certificate/certify.hpp"
#include "physics/modes/modal_scenes.hpp"
#include "support/test.hpp"

namespace ergotic::physics {
namespace {

double largestResidual(const Player& player) {
  const Energies energies = energiesOf(player);
  double turned_over = energies.stored;
  for (const SectionEnergy& s : energies.sections) {
    turned_over += std::abs(s.dissipated) + std::abs(s.from_inputs) + std::abs(s.from_device);
  }
  return std::abs(energies.residual) / turned_over;
}

/// Plays both with noise on the inputs and a hand that strikes now and then.
void play(Player& network, Player& modal, int frames) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise;
  for (int n = 0; n * kModalRates.ratio < frames; ++n) {
    for (std::size_t i = 0; i < network.inputs.size(); ++i) {
      network.inputs[i] = modal.inputs[i] = 0.1 * noise(random);
    }
    for (std::size_t p = 0; p < network.positions.size(); ++p) {
      network.positions[p] = modal.positions[p] = -1e-3 * std::sin(0.05 * n);
    }
    network.tick();
    modal.tick();
  }
}

void expectSameSound(const Player& network, const Player& modal, double tolerance) {
  for (std::size_t c = 0; c < network.heard.size(); ++c) {
    double peak = 0.0;
    double off = 0.0;
    for (std::size_t n = 0; n < network.heard[c].size(); ++n) {
      peak = std::max(peak, std::abs(network.heard[c][n]));
      off = std::max(off, std::abs(network.heard[c][n] - modal.heard[c][n]));
    }
    EXPECT_GT(peak, 0.0) << c;
    EXPECT_LT(off, tolerance * peak) << c;
  }
}

void expectSameGuards(const Player& network, const Player& modal) {
  std::vector<TankReport> expected = network.instrument->makeTankReports();
  std::vector<TankReport> reports = modal.instrument->makeTankReports();
  ASSERT_EQ(reports.size(), expected.size());
  network.instrument->readTanks(expected);
  modal.instrument->readTanks(reports);
  for (std::size_t g = 0; g < reports.size(); ++g) {
    EXPECT_EQ(reports[g].lia, expected[g].lia);
    EXPECT_GT(reports[g].active, 0);
    EXPECT_EQ(reports[g].active, expected[g].active);
    EXPECT_EQ(reports[g].clipped, expected[g].clipped);
  }
}

void expectExact(const scene::Scene& scene) {
  Player network(scene, kModalRates);
  Player modal(withModes(scene, scene::kAllModes), kModalRates);
  play(network, modal, 10000);
  expectSameSound(network, modal, 1e-10);
  EXPECT_LT(largestResidual(modal), 1e-11);
  expectSameGuards(network, modal);
}

TEST(ModalTest, StringWithAllModesMovesAsItsNetwork) {
  expectExact(dampedString().scene);
}

TEST(ModalTest, PlateWithAllModesMovesAsItsNetworkUnderContactsAndASlice) {
  expectExact(playedPlate().scene);
}

TEST(ModalTest, EveryInstructionSetGivesTheSameBits) {
  const scene::Scene scene =
      settle(withModes(playedPlate().scene, scene::kAllModes), kModalRates).scene;
  for (const Precision precision : {Precision::kFloat, Precision::kDouble}) {
    for (const rt::Isa isa : rt::isas()) {
      CompileOptions options(precision);
      options.isa = rt::Isa::kBaseline;
      Player plain(compile(scene, kModalRates, options));
      options.isa = isa;
      Player fast(compile(scene, kModalRates, options));
      play(plain, fast, 2000);
      EXPECT_EQ(plain.heard, fast.heard) << rt::nameOf(isa);
    }
  }
}

TEST(ModalTest, EvenNetsHaveModesThoughDampingIsNotInProportion) {
  SceneBuilder b;
  constexpr int kSide = 9;
  const double k = 0.1 * 1e-3 * kRate * kRate;
  const auto isEdge = [](int column, int row) {
    return column == 0 || row == 0 || column == kSide - 1 || row == kSide - 1;
  };
  for (int i = 0; i < kSide * kSide; ++i) {
    isEdge(i % kSide, i / kSide) ? b.ground() : b.mass(1e-3, 1e-4 * std::sin(1.3 * i));
  }
  const auto join = [&](int column, int row, int right, int down, double stiffness) {
    const int to = column + right;
    if (to >= 0 && to < kSide && row + down < kSide &&
        !(isEdge(column, row) && isEdge(to, row + down))) {
      b.spring(row * kSide + column, (row + down) * kSide + to, stiffness, 1e-7 * k);
    }
  };
  for (int i = 0; i < kSide * kSide; ++i) {
    join(i % kSide, i / kSide, 1, 0, k);
    join(i % kSide, i / kSide, 0, 1, k);
    join(i % kSide, i / kSide, 1, 1, 0.5 * k);
    join(i % kSide, i / kSide, -1, 1, 0.5 * k);
  }
  b.scene.sections[0].medium = {1e-3};
  b.hear(3 * kSide + 4, 0);
  b.hear(5 * kSide + 2, 1);
  b.push(2 * kSide + 2);
  b.push(4 * kSide + 4);
  expectExact(b.scene);
  EXPECT_THAT(described(withModes(b.scene, scene::kAllModes)), HasSubstr("all of them, so exact"));
  EXPECT_EQ(described(withModes(b.scene, scene::kAllModes)).find("stay modules"),
            std::string::npos);
}

TEST(ModalTest, SlowerSectionsMoveAsTheirNetwork) {
  Plate b = playedPlate();
  b.scene.sections[0].divisor = 5;
  for (scene::Lia& lia : b.scene.lias) {
    lia.stiffness.factor /= 25.0;
  }
  for (scene::Lia& lia : b.scene.lias) {
    lia.damping.factor /= 25.0;
  }
  expectExact(b.scene);
}

TEST(ModalTest, WholeStringsOfOneSectionHaveModesOfTheirOwn) {
  SceneBuilder b = dampedString();
  const double k = 0.3 * 2e-3 * kRate * kRate;
  const int other = b.chain(20, 2e-3, k, 1e-7 * k);
  b.scene.mats[at(other + 4)].position.x() = 1e-3;
  b.hear(other + 11, 4);
  b.spring(other + 9, 8, 1e4, 0.1);
  expectExact(b.scene);
  EXPECT_THAT(described(withModes(b.scene, scene::kAllModes)), HasSubstr("is played by 50 modes"));
}

TEST(ModalTest, SectionsFallAsleepAndWakeAsTheirNetwork) {
  SceneBuilder b;
  const double k = 0.3 * 1e-3 * kRate * kRate;
  const int first = b.chain(20, 1e-3, k, 1e-6 * k);
  b.scene.sections[0].medium = {0.5};
  b.scene.sections[0].sleep_energy = 1e-9;
  b.hear(first + 7);
  b.push(first + 4);
  Player network(b.scene, kModalRates);
  Player modal(withModes(b.scene, scene::kAllModes), kModalRates);
  for (int tick = 0; tick < 1000; ++tick) {
    const double force = tick % 400 == 0 ? 1.0 : 0.0;
    std::fill(network.inputs.begin(), network.inputs.end(), force);
    modal.inputs = network.inputs;
    network.tick();
    modal.tick();
  }
  expectSameSound(network, modal, 1e-10);
  EXPECT_EQ(modal.heard[0][3990], 0.0);
  EXPECT_NE(modal.heard[0][4050], 0.0);
}

/// What is linked to others stops where it is, and is seen there.
TEST(ModalTest, SectionsFallAsleepWhereTheyAre) {
  SceneBuilder b;
  const double k = 0.3 * 1e-3 * kRate * kRate;
  const int first = b.chain(20, 1e-3, k, 1e-6 * k);
  b.scene.mats[at(first + 7)].position.x() = 1e-3;
  b.scene.sections[0].medium = {0.5};
  b.scene.sections[0].sleep_energy = 1e-3;
  b.hear(first + 7);
  const int l = b.link(LiaType::kContact, first + 7, b.ground(0.0, SceneBuilder::kGestural), 1.0);
  b.scene.lias[at(l)].law.edit().width = {-1.0};  // is never reached
  Player network(b.scene, kModalRates);
  Player modal(withModes(b.scene, scene::kAllModes), kModalRates);
  play(network, modal, 3000);
  expectSameSound(network, modal, 1e-10);
  EXPECT_GT(std::abs(network.heard[0].back()), 1e-7);
  EXPECT_EQ(modal.heard[0].back(),
            modal.heard[0][at(static_cast<int>(modal.heard[0].size()) - 99)]);
}

TEST(ModalTest, PictureShowsModulesThatNothingTouches) {
  const Plate b = playedPlate();
  Player network(b.scene, kModalRates);
  Player modal(withModes(b.scene, scene::kAllModes), kModalRates);
  play(network, modal, 3000);
  std::vector<float> exact(at(b.scene.coordinates()));
  std::vector<float> seen(exact.size());
  network.instrument->readDisplacements(exact.data());
  modal.instrument->readDisplacements(seen.data());
  float largest = 0.0F;
  for (const float x : exact) {
    largest = std::max(largest, std::abs(x));
  }
  double off = 0.0;
  double all = 0.0;
  for (std::size_t m = 0; m < exact.size(); ++m) {
    EXPECT_NEAR(seen[m], exact[m], 0.2F * largest) << m;
    const bool is_of_plate = m < at(Plate::kColumns * Plate::kRows);
    off += is_of_plate ? std::pow(seen[m] - exact[m], 2) : 0.0;
    all += is_of_plate ? std::pow(exact[m] - exact[0], 2) : 0.0;
  }
  EXPECT_LT(off, 1e-3 * all);
  EXPECT_NEAR(seen[at(b.of(3, 4))], exact[at(b.of(3, 4))], 1e-6F * largest);
}

TEST(ModalTest, FewLinksThatAreDampedDifferentlyStayLinks) {
  SceneBuilder b = dampedString();
  b.scene.lias[5].damping.factor *= 3.0;
  b.scene.mats[21].mass.parameter = 0;
  b.scene.parameters.push_back({"weight", 1.0, 0.5, 2.0, {}});
  expectExact(b.scene);
  EXPECT_THAT(described(withModes(b.scene, scene::kAllModes)),
              HasSubstr("some stay modules: module 'm21'"));
}

TEST(ModalTest, PlacesBetweenModulesAndGroundsAreFollowed) {
  SceneBuilder b = dampedString();
  b.scene.outputs.pop_back();  // the force on the ground that the place leans on
  const int place = b.point(b.grid(0, 32), 0.4 / 31.0);
  b.scene.mats[at(place)].rest.x() = 0.25;
  b.hear(place, 3);
  b.spring(place, b.ground(3e-4), 2e3, 0.05);
  expectExact(b.scene);
}

TEST(ModalTest, ForcesOnTheirModulesAreThoseOfOtherGeometriesToo) {
  SceneBuilder b = dampedString();
  scene::Section plane;
  plane.name = "plane";
  plane.geometry = scene::Geometry::kPlane;
  b.scene.sections.push_back(plane);
  const int anchor = b.ground(0.0, 2);
  b.scene.mats.back().position.y() = 0.05;
  b.scene.mats.back().rest.y() = 0.05;
  b.spring(anchor, 14, 3e3, 0.02);
  expectExact(b.scene);
}

TEST(ModalTest, EigenvaluesAcrossRatesProveNothingOfFewerModes) {
  SceneBuilder b;
  const double k = 0.9 * 1e-3 * kRate * kRate;
  const int first = b.chain(20, 1e-3, k, 1e-7 * k);
  const int slow = b.mass(0.05, 0.0, 0.0, SceneBuilder::kGestural);
  b.spring(slow, b.ground(0.0, SceneBuilder::kGestural), 1e3, 0.1);
  b.spring(slow, first + 5, 1e3, 0.1);
  const Certificate all = certify(withModes(b.scene, scene::kAllModes), kModalRates);
  const Certificate some = certify(withModes(b.scene, 10), kModalRates);
  EXPECT_EQ(all.verdict, Verdict::kPassive);
  EXPECT_EQ(some.verdict, Verdict::kUnproven);
  ASSERT_EQ(some.findings.size(), 1U);
  EXPECT_THAT(some.findings[0], HasSubstr("all modes"));
}

/// With modes left out a force at one place moves the others within the step.
TEST(ModalTest, EnergyStableLinksOnPlacesThatMoveEachOtherMakeNothing) {
  Plate b(0.1 * Plate::kMass * kRate * kRate, 1e-3);
  for (const int m : {b.of(2, 3), b.of(3, 3), b.of(7, 7)}) {
    const int hammer = b.mass(2e-3, 1e-4, -2.0);
    b.link(scene::LiaType::kContact, m, hammer, 2e5);
    b.scene.lias.back().scheme = scene::Scheme::kEnergyStable;
    b.spring(hammer, b.ground(1e-4), 100.0);
  }
  b.hear(b.of(2, 3));
  for (const int modes : {6, 40}) {
    Player player(withModes(b.scene, modes), kModalRates);
    player.tick();
    Energies energies = energiesOf(player);
    const double start = energies.stored;
    for (int n = 0; n < 2000; ++n) {
      player.tick();
      player.instrument->readEnergies(energies);
      ASSERT_LT(std::abs(energies.residual), 1e-11 * start) << n;
      ASSERT_LT(energies.stored, start * (1.0 + 1e-9)) << n;
    }
    EXPECT_GT(std::abs(player.heard[0].back()), 1e-9);
  }
}

TEST(ModalTest, PlacesThatAModuleLeadsAreLedByItsModes) {
  SceneBuilder b = dampedString();
  scene::Section other = b.scene.sections[0];
  other.name = "other";
  other.gravity.setZero();
  b.scene.sections.push_back(other);
  const int first = static_cast<int>(b.scene.mats.size());
  for (int i = 0; i < 5; ++i) {
    b.ground(1e-3 * i, 2);
  }
  b.hear(b.point(b.grid(first, 5), 0.5), 4);
  b.scene.connections.back().along.guide = 11;
  b.scene.connections.back().along.scale = 20.0;
  expectExact(b.scene);
}

TEST(ModalTest, TapsOnAStringAreTapsOnItsModes) {
  SceneBuilder b = dampedString();
  const int tap = b.tap({{3, 0.7}, {8, -1.4}, {21, 2.0}, {0, 0.3}});
  b.scene.outputs.pop_back();  // the force on the ground under it
  b.hear(tap, 3);
  b.push(tap);
  b.link(scene::LiaType::kContact, tap, b.ground(2e-4), 2e5, 1e-3);
  b.scene.lias.back().scheme = scene::Scheme::kEnergyStable;
  b.spring(tap, b.ground(), 1e3);
  expectExact(b.scene);
}

TEST(ModalTest, CertificateIsThatOfTheNetwork) {
  const Plate b = playedPlate();
  const Certificate network = certify(b.scene, kModalRates);
  const Certificate modal = certify(withModes(b.scene, scene::kAllModes), kModalRates);
  EXPECT_EQ(modal.verdict, network.verdict);
  EXPECT_EQ(modal.margin(), network.margin());
}

}  // namespace
}  // namespace ergotic::physics
