// SPDX-License-Identifier: BSD-3-Clause
// Scenes that grow, and of which it was once said that they cannot. Each is played, to see that it
// does grow, and must not be certified.
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/certificate/grown.hpp"

namespace ergotic::physics {
namespace {

TEST(CertifiedTest, ContactsOnOneMassAddUp) {
  SceneBuilder b;
  const int mass = b.mass(1.0, 0.0, 0.44);
  const double k = 0.049 * kRate * kRate;
  for (int n = 0; n < 80; ++n) {
    const bool is_right = n % 2 == 0;
    const int wall = b.ground(0.0);
    b.link(LiaType::kContact, is_right ? wall : mass, is_right ? mass : wall, k);
    b.scene.lias.back().law.edit().width = {-1e-4};
  }
  expectRefused(b, 14, 3.0, 1e3);
  for (scene::Lia& lia : b.scene.lias) {
    lia.scheme = Scheme::kAuto;
  }
  EXPECT_EQ(certify(settle(b.scene, {kRate, 14}).scene, {kRate, 14}).verdict, Verdict::kPassive);
}

/// A mass that swings in two, three or four steps a period meets what is wrong about a step at the
/// same phase again and again, so that it is pumped by what is soft, and damped, in itself.
SceneBuilder swinging(double kappa, double x, double v) {
  SceneBuilder b;
  const int mass = b.mass(1.0, x, v);
  b.spring(mass, b.ground(), kappa * kRate * kRate);
  return b;
}

TEST(CertifiedTest, DampedContactPumpsWhatSwingsInTimeWithTheSteps) {
  SceneBuilder b = swinging(2.975, 1e-4, 1.0);
  b.link(LiaType::kContact, 1, 0, 0.0499 * kRate * kRate, 0.0024 * kRate);
  expectRefused(b, 14, 0.5, 1e12);
  b.scene.lias[1].scheme = Scheme::kAuto;
  EXPECT_EQ(certify(settle(b.scene, {kRate, 14}).scene, {kRate, 14}).verdict, Verdict::kPassive);
}

TEST(CertifiedTest, SoftPluckPumpsWhatSwingsInTimeWithTheSteps) {
  SceneBuilder b = swinging(3.0, 3e-4, 20.0);
  b.link(LiaType::kPluck, 1, 0, 0.2 * kRate * kRate);
  b.scene.lias[1].law.edit().width = {5e-4};
  expectRefused(b, 14, 2.0, 20.0);
  b.scene.lias[0].damping = {0.01 * kRate};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
}

/// A pluck is a hill of potential, so its tank has nothing to cut.
TEST(CertifiedTest, EnergyStablePluckPlaysAsTheExplicitOne) {
  for (const double speed : {0.4, 0.9, 1.1}) {  // of what takes it over the hill
    double after[2];
    for (const Scheme scheme : {Scheme::kExplicit, Scheme::kEnergyStable}) {
      SceneBuilder b;
      const double k = 0.04 * kRate * kRate;
      const int mass = b.mass(1.0, -0.0101, speed * 0.01 * std::sqrt(0.09 * k));
      b.link(LiaType::kPluck, mass, b.ground(), k);
      b.scene.lias[0].law.edit().width = {0.01};
      b.scene.lias[0].scheme = scheme;
      b.hear(mass, 0, Quantity::kVelocity);
      Player player(compile(b.scene, {kRate, 1}, Precision::kDouble));
      for (int n = 0; n < 4000; ++n) {
        player.tick();
      }
      after[scheme == Scheme::kEnergyStable ? 1 : 0] = player.heard[0].back();
    }
    EXPECT_EQ(after[0] > 0.0, speed > 1.0);
    EXPECT_NEAR(after[1], after[0], 1e-9 * std::abs(after[0])) << speed;
  }
}

TEST(CertifiedTest, BowPumpsWhatSwingsInTimeWithTheSteps) {
  double most = 0.0;
  for (int phase = 0; phase < 24; ++phase) {
    const double angle = 2.0 * kPi * phase / 24.0;
    SceneBuilder b = swinging(1.99985, 30.0 * std::cos(angle) / kRate, 42.0 * std::sin(angle));
    b.link(LiaType::kBow, 1, 0, 0.0, 0.45 * kRate);
    b.scene.lias[1].law.edit().width = {3.0};
    const Grown bowed = grown(b, 14, 1.5, Precision::kDouble);
    EXPECT_EQ(bowed.certificate.verdict, Verdict::kUnproven);
    most = std::max(most, bowed.times);
    b.scene.lias[1].scheme = Scheme::kAuto;
    EXPECT_EQ(settle(b.scene, {kRate, 14}).scene.lias[1].scheme, Scheme::kEnergyStable);
    b.scene.lias[0].damping = {1e-3 * kRate};
    EXPECT_EQ(settle(b.scene, {kRate, 14}).scene.lias[1].scheme, Scheme::kExplicit);
  }
  EXPECT_GT(most, 20.0);
}

SceneBuilder onATable(scene::Table elastic, scene::Table viscous) {
  SceneBuilder b;
  const int mass = b.mass(0.01, 0.0, 0.1);
  scene::Lia& lia = b.scene.lias[at(b.link(LiaType::kTable, mass, b.ground(), 0.0))];
  lia.law.edit().table = std::move(elastic);
  lia.law.edit().viscous_table = std::move(viscous);
  return b;
}

TEST(CertifiedTest, TablesWhoseEndsDriveGiveForEver) {
  const scene::Table outwards{{{-1.0, 1.0}, {1.0, -1.0}}};
  const scene::Table inwards{{{-1.0, -1.0}, {1.0, 1.0}}};
  expectRefused(onATable({}, outwards), 14, 2.0, 1e3);
  expectRefused(onATable(outwards, {}), 14, 2.0, 1e3);
  SceneBuilder sound = onATable(inwards, inwards);
  sound.spring(0, 1, 0.0, 1e-3);
  EXPECT_EQ(certify(sound.scene, {kRate, 14}).verdict, Verdict::kBounded);
}

/// A tank gives what it holds, and no more: down the slope of a table, half a joule.
TEST(CertifiedTest, EnergyStableTablesGiveWhatTheyHadAtTheStart) {
  SceneBuilder b = onATable({{{-1.0, 1.0}, {1.0, -1.0}}}, {});
  b.scene.lias[0].scheme = Scheme::kEnergyStable;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded) << "it falls";
  Player player(compile(b.scene, {kRate, 14}, Precision::kDouble));
  Energies energies = player.instrument->makeEnergies();
  player.instrument->readEnergies(energies);
  const double start = energies.sections[0].kinetic + 0.5;
  for (int n = 0; n < 10000; ++n) {
    player.tick();
    player.instrument->readEnergies(energies);
    ASSERT_LE(energies.sections[0].kinetic, start * (1.0 + 1e-9)) << n;
  }
  EXPECT_GT(energies.sections[0].kinetic, 0.4);
}

TEST(CertifiedTest, WhatSnapsFeedsEnergyIn) {
  struct Snap {
    LiaType type;
    double width;
    double x;
    double times;
  };
  for (const Snap& snap :
       {Snap{LiaType::kConditional, 5e-3, 0.03, 1e3}, {LiaType::kPluck, 3e-4, 0.0, 3.0}}) {
    SceneBuilder b;
    // A mass that swings through a point where something snaps at every pass.
    const int mass = b.mass(1.0, snap.x, 6.0);
    b.spring(mass, b.ground(), 1e-5 * kRate * kRate);
    scene::Lia& lia = b.scene.lias[at(b.link(snap.type, mass, b.ground(), 3.5 * kRate * kRate))];
    lia.law.edit().width = {snap.width};
    lia.law.edit().release = 1e-2;
    SCOPED_TRACE(static_cast<int>(snap.type));
    expectRefused(b, 14, 20.0, snap.times);
    b.scene.lias[1].scheme = Scheme::kEnergyStable;
    const Grown energy_stable = grown(b, 14, 20.0, Precision::kDouble);
    // It falls into a well once, and no deeper at any later pass.
    EXPECT_LT(energy_stable.times,
              1.0 + 3.5 * kRate * kRate * snap.width * snap.width / (6.0 * 6.0));
    EXPECT_EQ(energy_stable.certificate.verdict, Verdict::kBounded);
    b.scene.lias[1].scheme = Scheme::kExplicit;
    // Where all that it reaches loses energy, what it gives is bounded, as its force is.
    b.scene.lias[0].damping = {10.0};
    EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
  }
}

TEST(CertifiedTest, FloatRoundsCoefficientsAtTheLimitToo) {
  const auto oscillator = [](double below) {
    SceneBuilder b;
    const int mass = b.mass(0.7, 0.0, 1e-3);
    b.spring(mass, b.ground(), 4.0 * (1.0 - below) * 0.7 * kRate * kRate);
    return b;
  };
  EXPECT_EQ(certify(oscillator(5e-7).scene, {kRate, 14}).verdict, Verdict::kUnproven);
  const Grown near = grown(oscillator(2e-6), 14, 10.0, Precision::kFloat);
  EXPECT_EQ(near.certificate.verdict, Verdict::kPassive);
  EXPECT_LT(near.times, 1e7) << "it breathes by 4/(4 - lambda)";
}

TEST(CertifiedTest, SlowGrowthIsNoRigidMotion) {
  const double angle = 5e-7;
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  EXPECT_NEAR(spectralRadius((1.0 + 5e-8) * turn), 1.0 + 5e-8, 1e-12);
  SceneBuilder b;  // free in all: a double 1
  const int slow = b.mass(1.0, 0.0, 0.0, SceneBuilder::kGestural);
  b.spring(slow, b.mass(1.0), 100.0);
  EXPECT_LE(spectralRadius(monodromy(b.scene, {kRate, 14})), 1.0 + 1e-12);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
}

TEST(CertifiedTest, EigenvaluesThatCannotBeWorkedOutAreNone) {
  Eigen::Matrix3d matrix = 0.5 * Eigen::Matrix3d::Identity();
  for (const double value : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    matrix(1, 2) = value;
    EXPECT_TRUE(std::isnan(spectralRadius(matrix)));
  }
}

/// What loses energy, by a damper to the ground, and snaps: bounded. Not so if an energy-stable
/// contact hands what it is given on to a mass that loses nothing.
TEST(CertifiedTest, EnergyStableLinksHandOnWhatSnapsGive) {
  SceneBuilder b;
  const int mass = b.mass(1.0);
  b.spring(mass, b.ground(), 1e-5 * kRate * kRate, 10.0);
  b.link(LiaType::kConditional, mass, b.ground(), 3.5 * kRate * kRate);
  b.scene.lias.back().law.edit().width = {5e-3};
  b.scene.lias.back().law.edit().release = 1e-2;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
  const int cell = b.cell(1.0, 0.0, 1.0);
  b.link(LiaType::kContact, mass, cell, 1e3);
  b.scene.lias.back().scheme = Scheme::kEnergyStable;
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kBounded);
  b.scene.parameters.push_back({"loss", 1.0, 0.0, 1.0, {}});
  b.scene.mats[at(cell)].damping = {1.0, 0};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven) << "it may be 0";
  b.scene.mats[at(cell)] = b.scene.mats[at(b.mass(1.0))];
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven);
}

/// However little is missing beside what is stiff elsewhere, what is negative grows.
TEST(CertifiedTest, NegativeStiffnessIsNotHiddenByWhatIsStiffElsewhere) {
  SceneBuilder b;
  b.spring(b.mass(1.0), b.ground(), 7.5e9);
  const int light = b.mass(1.0, 1e-6);
  b.spring(light, b.ground(), -7.0);
  Player player(compile(b.scene, {kRate, 14}, Precision::kDouble));
  for (int n = 0; n < 10 * 3150; ++n) {
    player.tick();
  }
  EXPECT_GT(kineticEnergy(player), 1e3);
  EXPECT_GE(certify(b.scene, {kRate, 14}).verdict, Verdict::kUnproven);
  b.spring(light, b.ground(), 8.0);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive) << "it is held by 1 N/m";
}

double energyGrowthOf(const scene::Scene& scene, double seconds) {
  Player player(compile(scene, {kRate, 14}, Precision::kDouble));
  const double start = kineticEnergy(player);
  player.ticks(static_cast<int>(seconds * kRate / 14));
  return kineticEnergy(player) / start;
}

/// A mass in a plane that something pushes away, and that a scalar spring holds along one axis.
TEST(CertifiedTest, OneAxisDoesNotMakeUpForAnother) {
  for (const char* const geometry : {"plane", "scalar"}) {
    const scene::Scene scene = scene::readYaml(
        "ergotic: 1\nsections: {s: {}, p: {geometry: " + std::string(geometry) +
            "}}\nmats:\n  g: {type: ground, section: s}\n  gp: {type: ground, section: p}\n"
            "  m: {type: mass, section: p, mass: 1, v: " +
            (geometry[0] == 'p' ? "[0, 1e-4]" : "1e-4") +
            "}\nlias:\n  n: {type: spring, between: [m, gp], stiffness: -1000}\n"
            "  k: {type: spring, between: [m, g], stiffness: 3000}\n",
        "axes.yaml");
    const bool is_plane = geometry[0] == 'p';
    EXPECT_EQ(energyGrowthOf(scene, 0.5) > 1e10, is_plane);
    EXPECT_EQ(certify(scene, {kRate, 14}).verdict,
              is_plane ? Verdict::kUnproven : Verdict::kPassive);
  }
}

/// A damper does nothing to what moves across the axis of its other end.
TEST(CertifiedTest, DampersAcrossTakeNothing) {
  for (const char* const angle : {"0", "1.5707963267948966"}) {
    scene::Scene scene = scene::readYaml(
        "ergotic: 1\nsections:\n  s: {}\n  l: {geometry: line, pose: {rotation: [0, 0, " +
            std::string(angle) +
            "]}}\nmats:\n  g: {type: ground, section: s}\n  gl: {type: ground, section: l}\n"
            "  d: {type: mass, section: s, mass: 1}\n"
            "  m: {type: mass, section: l, mass: 1, x: 0.0003, v: 20}\nlias:\n"
            "  own: {type: spring, between: [m, gl], stiffness: 5834430000}\n"
            "  loss: {type: damper, between: [m, d], damping: 441}\n"
            "  more: {type: damper, between: [d, g], damping: 441}\n"
            "  p: {type: pluck, between: [m, gl], stiffness: 388962000, width: 0.0005, "
            "scheme: explicit}\n",
        "across.yaml");
    const bool is_across = angle[0] == '1';
    EXPECT_EQ(energyGrowthOf(scene, 1.0) > 1e4, is_across);
    EXPECT_EQ(certify(scene, {kRate, 14}).verdict, Verdict::kUnproven);
    scene.mats[3].type = scene::MatType::kCell;
    scene.mats[3].damping = {441.0};
    EXPECT_EQ(certify(scene, {kRate, 14}).verdict, Verdict::kBounded);
  }
}

/// A table that has no elastic part switches no stiffness, whatever else acts on its mass.
TEST(CertifiedTest, WhatSwitchesIsNamed) {
  SceneBuilder b;
  const int mass = b.mass(1.0);
  b.link(LiaType::kTable, mass, b.ground(), 0.0);
  b.scene.lias.back().law.edit().viscous_table.points = {{-1.0, -1.0}, {1.0, 1.0}};
  b.link(LiaType::kContact, mass, b.ground(), 0.2 * kRate * kRate);
  const Certificate c = certify(b.scene, {kRate, 14});
  EXPECT_EQ(c.verdict, Verdict::kUnproven);
  ASSERT_EQ(c.findings.size(), 1U);
  EXPECT_THAT(c.findings[0], HasSubstr("link 'l1'"));
}

}  // namespace
}  // namespace ergotic::physics
