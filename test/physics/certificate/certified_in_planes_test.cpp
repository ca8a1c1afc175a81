// SPDX-License-Identifier: BSD-3-Clause
// Planes and lines: scenes that grow there, or that no scalar network stands for.
#include <string>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// Of a second; rounding must first find what grows.
bool growsAMillionfold(const scene::Scene& scene, int ratio) {
  Player player(compile(scene, {kRate, ratio}, Precision::kDouble));
  player.tick();
  const double start = kineticEnergy(player);
  double most = start;
  for (int n = 0; n < kRate / ratio && most <= 1e6 * start; ++n) {
    player.tick();
    most = std::max(most, kineticEnergy(player));
  }
  return most > 1e6 * start;
}

/// Two masses in a plane. The light one has a heavy damper, along a line that turns: what the
/// damper takes in one direction it gives in another. Energy-stable it only takes.
std::string turning(const std::string& scheme) {
  return "ergotic: 1\nsections:\n  s: {rate: audio, geometry: plane}\nmats:\n"
         "  g: {type: ground, section: s}\n"
         "  a: {type: mass, section: s, mass: 0.134767, at: [0.001, 0.0003], v: [3, 11]}\n"
         "  b: {type: mass, section: s, mass: 1.23455, at: [0.0005, -0.0003], v: [30, -5]}\nlias:\n"
         "  k: {type: spring, between: [a, b], stiffness: 37905309}\n"
         "  kb: {type: spring, between: [b, g], stiffness: 555195856}\n"
         "  z: {type: damper, between: [a, g], damping: 11425.2" +
         scheme + "}\n";
}

TEST(CertifiedInPlanesTest, DampersAlongLinesThatTurnDrive) {
  for (const std::string scheme : {", scheme: explicit", ""}) {
    const bool is_explicit = !scheme.empty();
    const scene::Scene scene =
        settle(scene::readYaml(turning(scheme), "turning.yaml"), {kRate, 14}).scene;
    EXPECT_EQ(growsAMillionfold(scene, 14), is_explicit);
    EXPECT_EQ(certify(scene, {kRate, 14}).verdict,
              is_explicit ? Verdict::kUnproven : Verdict::kPassive);
  }
}

std::string tilted(double angle) {
  return "ergotic: 1\ngestural_rate: 14700\nsections:\n"
         "  fast: {rate: audio, geometry: plane, pose: {rotation: [" +
         std::to_string(angle) +
         ", 0, 0]}}\n  slow: {rate: gestural, geometry: plane}\nmats:\n"
         "  gf: {type: ground, section: fast}\n  gs: {type: ground, section: slow}\n"
         "  s: {type: mass, section: slow, mass: 1, x: [0.0001, 0.0002]}\n"
         "  f: {type: mass, section: fast, mass: 3.976, x: [0.0002, -0.0001]}\nlias:\n"
         "  a: {type: spring, between: [s, gs], stiffness: 244852171}\n"
         "  b: {type: spring, between: [f, gf], stiffness: 7347909221}\n"
         "  c: {type: spring, between: [s, f], stiffness: 555382209}\n";
}

/// Across the axis that both planes have, one is seen shortened: that is another network.
TEST(CertifiedInPlanesTest, PlanesThatAreTiltedAreNoOneLine) {
  for (const double angle : {0.0, 0.999779871847}) {
    const scene::Scene scene = scene::readYaml(tilted(angle), "tilted.yaml");
    EXPECT_EQ(growsAMillionfold(scene, 3), angle != 0.0);
    EXPECT_EQ(certify(scene, {kRate, 3}).verdict,
              angle != 0.0 ? Verdict::kUnproven : Verdict::kPassive);
  }
}

/// A line sees what moves along another axis shortened.
TEST(CertifiedInPlanesTest, LinesThatAreTiltedAgainstScalarSectionsAreNoOneLine) {
  for (const bool is_tilted : {false, true}) {
    const std::string pose = ", pose: {rotation: [0, 0, 1.0]}";
    const scene::Scene scene = scene::readYaml(
        "ergotic: 1\nsections:\n  s: {rate: {divisor: 28}, geometry: line" +
            (is_tilted ? pose : std::string()) +
            "}\n  f: {rate: {divisor: 14}}\nmats:\n  g: {type: ground, section: s}\n"
            "  a: {type: mass, section: s, mass: 0.1}\n  b: {type: mass, section: f, mass: 0.1}\n"
            "lias:\n  k: {type: spring, between: [a, g], stiffness: 1000}\n"
            "  c: {type: spring, between: [b, a], stiffness: 1000}\n",
        "tilted.yaml");
    EXPECT_EQ(certify(scene, {kRate, 14}).verdict,
              is_tilted ? Verdict::kUnproven : Verdict::kPassive);
  }
}

/// A ring of three masses, two of them scalar and joined by the axis that these have in common, the
/// third one in a line. Where one of the two sees the line turned round no displacements of the
/// three make up for that: the highest mode takes 4 k/M, not 3 k/M.
TEST(CertifiedInPlanesTest, RingsThatSeeOneAxisTurnedRoundAreStiffer) {
  for (const bool is_turned : {false, true}) {
    const std::string k = ", stiffness: 23.3e6}\n";  // h^2 k/M = 1.198
    const scene::Scene scene = scene::readYaml(
        std::string("ergotic: 1\nsections:\n  s: {}\n  t: {pose: {rotation: [0, 0, ") +
            (is_turned ? "3.141592653589793" : "0") +
            "]}}\n  l: {geometry: line}\nmats:\n  a: {type: mass, section: s, mass: 0.01, v: 1}\n"
            "  b: {type: mass, section: t, mass: 0.01}\n"
            "  c: {type: mass, section: l, mass: 0.01}\n"
            "lias:\n  ab: {type: spring, between: [a, b]" +
            k + "  bc: {type: spring, between: [b, c]" + k +
            "  ca: {type: spring, between: [c, a]" + k,
        "ring.yaml");
    EXPECT_EQ(growsAMillionfold(scene, 14), is_turned);
    EXPECT_EQ(certify(scene, {kRate, 14}).verdict,
              is_turned ? Verdict::kUnproven : Verdict::kPassive);
  }
}

/// Whatever is advised against a damper between two geometries can be done.
TEST(CertifiedInPlanesTest, DampersBetweenALineAndAPlaneMayBeEnergyStable) {
  for (const std::string between : {"[a, b]", "[b, a]"}) {
    const scene::Scene scene = scene::readYaml(
        "ergotic: 1\nsections: {l: {geometry: line}, p: {geometry: plane}}\nmats:\n"
        "  a: {type: mass, section: l, mass: 1}\n  b: {type: mass, section: p, mass: 1}\n"
        "lias: {z: {type: spring_damper, between: " +
            between + ", stiffness: 1000, damping: 1}}\n",
        "line.yaml");
    EXPECT_EQ(certify(settle(scene, {kRate, 14}).scene, {kRate, 14}).verdict, Verdict::kPassive)
        << between;
  }
}

/// What circles keeps its distance, and its energy: only dampers of masses take that in a plane.
TEST(CertifiedInPlanesTest, DampersOfLinksAreNoLossInAPlane) {
  for (const bool is_damped : {false, true}) {
    const std::string text =
        std::string("ergotic: 1\nsections:\n  s: {rate: audio, geometry: plane") +
        (is_damped ? ", medium: 1" : "") +
        "}\nmats:\n  g: {type: ground, section: s}\n"
        "  a: {type: mass, section: s, mass: 1, at: [0.1, 0]}\nlias:\n  k: {type: spring, between: "
        "[a, g], stiffness: 1e6}\n"
        "  z: {type: damper, between: [a, g], damping: 10, scheme: energy_stable}\n"
        "  p: {type: pluck, between: [a, g], stiffness: 1e4, width: 0.01, scheme: explicit}\n";
    EXPECT_EQ(certify(scene::readYaml(text, "circle.yaml"), {kRate, 14}).verdict,
              is_damped ? Verdict::kBounded : Verdict::kUnproven);
  }
}

}  // namespace
}  // namespace ergotic::physics
