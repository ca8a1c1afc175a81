// SPDX-License-Identifier: BSD-3-Clause
// Scenes of several rates that grow, and of which it was once said that they cannot.
#include "ergotic/physics/certificate/monodromy.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/certificate/grown.hpp"

namespace ergotic::physics {
namespace {

/// A slow mass and a fast one, each with a spring to the ground, and what joins them.
SceneBuilder twoMasses(double slow, double coupling, double z, double fast, double fast_mass) {
  SceneBuilder b;
  const int heavy = b.mass(1.0, 0.0, 0.01, SceneBuilder::kGestural);
  b.spring(heavy, b.ground(0.0, SceneBuilder::kGestural), slow);
  const int light = b.mass(fast_mass);
  b.spring(heavy, light, coupling, z);
  b.spring(light, b.ground(), fast);
  return b;
}

TEST(CertifiedRatesTest, SoftCouplingsOfLowModesGrowAllTheSame) {
  expectRefused(twoMasses(24703385.68, 7521536.778, 0.0, 32707988.93, 0.4417203012), 14, 1.0, 1e6);
  expectRefused(twoMasses(18522197.78, 23580390.53, 232.5266722, 8992567.081, 0.4100447551), 8, 3.0,
                1e6);
}

/// Nothing holds them, and their fast mode makes nearly a whole turn in a tick: it meets the motion
/// of both together.
TEST(CertifiedRatesTest, AFreePairThatNearlyTurnsRoundInATickGrows) {
  SceneBuilder b;
  const int light = b.mass(0.0182940937, 0.0, 2.77576185);
  const int heavy = b.mass(0.0842841903, 0.0, -1.94045476, SceneBuilder::kGestural);
  b.spring(heavy, light, 4902066.90839164, 0.020725701);
  b.spring(light, heavy, 11298.1592719748, 0.273010857);
  expectRefused(b, 14, 60.0, 1e4);
}

/// Modes of which neither grows, and which hide in what heavy masses hardly do: what light ones
/// begin becomes a million times as much energy before it comes back.
TEST(CertifiedRatesTest, WhatBeatsBetweenHeavyAndLightMassesGrows) {
  SceneBuilder b;
  for (const int divisor : {28, 56}) {
    scene::Section section = b.scene.sections[0];
    section.name = "d" + std::to_string(divisor);
    section.divisor = divisor;
    b.scene.sections.push_back(section);
  }
  const int light = b.mass(0.0116494483921898, 0.0, 0.065);
  b.spring(b.mass(216.074776709087, 0.0, 0.065, 2), light, 522259.432871975);
  b.spring(b.mass(17.697480567237, 0.0, 0.065, 3), light, 613674.464088179);
  expectRefused(b, 28, 6.0, 1e5);
}

/// The same of two modes that turn by nearly half in a tick, and fade in the end.
TEST(CertifiedRatesTest, WhatBeatsNearHalfTheRateGrows) {
  SceneBuilder b;
  constexpr int kSlow = SceneBuilder::kGestural;
  const int light = b.mass(0.224076434747274, -3.33654154496943e-05, -0.0702246600549671);
  const int one = b.mass(0.0110200434572094, 2.56935913655224e-06, 0.0215786811961234, kSlow);
  const int two = b.mass(0.0730930955393578, 0.000318423105262339, 2.55211949182771, kSlow);
  const int heavy = b.mass(59.6702668413264, 2.53302393810226e-07, -0.000216424970634361, kSlow);
  b.spring(one, light, 52269.2627321423, 0.0663713678154527);
  b.spring(two, light, 3958145.94894945, 0.117359594555846);
  b.spring(heavy, two, 324998.534199196, 0.0058111364095351);
  b.spring(one, b.ground(), 1763.75248479519, 4.54211474461765e-05);
  expectRefused(b, 11, 0.5, 1e3);
}

/// A damper takes nearly all that the coupling gives: 1e-7 of each period is left, or less than
/// nothing, by more than rounding or not.
TEST(CertifiedRatesTest, SlowGrowthOfTwoRatesIsGrowth) {
  const auto certified = [](double z, double growth) {
    SceneBuilder b = twoMasses(24703385.68, 6434440.0, 0.0, 32707988.93, 0.4417203012);
    b.scene.lias[2].damping = {z};
    EXPECT_NEAR(spectralRadius(monodromy(b.scene, {kRate, 14})), 1.0 + growth, 1e-8);
    return certify(b.scene, {kRate, 14});
  };
  const Certificate growing = certified(53.8864731, 1e-7);
  EXPECT_EQ(growing.verdict, Verdict::kUnproven);
  EXPECT_THAT(growing.findings, Contains(HasSubstr("grows by a factor of exp(")));
  EXPECT_EQ(certified(53.8883209, -2.86e-7).verdict, Verdict::kUnproven);  // as it may be rounded
  EXPECT_EQ(certified(53.9054, -3.856e-6).verdict, Verdict::kPassive);
}

// Its steps are within 2e-5 of the limit, and 2 J come to a million. One rate lends a million, too,
// at the limit that is certified.
TEST(CertifiedRatesTest, WhatLendsMoreThanOneRateMayIsNotCertified) {
  SceneBuilder b;
  const int light =
      b.mass(0.0102795860132335, 0.000553507186320735, 6.97434537201312, SceneBuilder::kGestural);
  const int heavy = b.mass(416.448027383063, -0.000553507186320735, -1.23687904751738e-05);
  b.spring(light, heavy, 407991.306543147, 0.000287518714261453);
  expectRefused(b, 14, 2.0, 1e5);
}

TEST(CertifiedRatesTest, DampersThatComeAndGoDrive) {
  SceneBuilder b;
  const int mass = b.mass(1.0, 1e-4, 1.0);
  b.spring(mass, b.ground(), 2.6032897528950336 * kRate * kRate);
  b.link(LiaType::kContact, mass, b.ground(), 0.0, 0.5227855135986955 * kRate);
  expectRefused(b, 14, 0.1, 1e6);
}

/// A mass in a plane between two slow ones, each of which moves along another of its axes.
std::string twoAxes(const std::string& rotation) {
  return "ergotic: 1\ngestural_rate: 3150\nsections:\n"
         "  fast: {rate: audio, geometry: plane}\n  along: {rate: gestural}\n"
         "  across: {rate: gestural, pose: {position: [0, 0, 0], rotation: [0, 0, " +
         rotation +
         "]}}\nmats:\n  gf: {type: ground, section: fast}\n  ga: {type: ground, section: along}\n"
         "  a: {type: mass, section: along, mass: 1, v: 0.01}\n"
         "  b: {type: mass, section: across, mass: 1}\n"
         "  f: {type: mass, section: fast, mass: 0.4417203012}\nlias:\n"
         "  own_a: {type: spring, between: [a, ga], stiffness: 24703385.68}\n"
         "  own_f: {type: spring, between: [f, gf], stiffness: 32707988.93}\n"
         "  to_a: {type: spring, between: [a, f], stiffness: 7521536.778}\n"
         "  to_b: {type: spring, between: [b, f], stiffness: 3e6}\n";
}

TEST(CertifiedRatesTest, WhatMovesAcrossMovesByItself) {
  const scene::Scene across = scene::readYaml(twoAxes("1.5707963267948966"), "axes.yaml");
  const scene::Scene along = scene::readYaml(twoAxes("0"), "axes.yaml");
  Player player(compile(across, {kRate, 14}, Precision::kDouble));
  const double start = kineticEnergy(player);
  for (int n = 0; n < 500; ++n) {
    player.tick();
  }
  EXPECT_GT(kineticEnergy(player), 1e6 * start);
  EXPECT_EQ(certify(across, {kRate, 14}).verdict, Verdict::kUnproven);
  EXPECT_EQ(certify(along, {kRate, 14}).verdict, Verdict::kPassive);
}

}  // namespace
}  // namespace ergotic::physics
