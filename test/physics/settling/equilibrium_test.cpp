// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/documents.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr double kG = 9.81;

Settled settled(const std::string& parts, const std::string& section = "") {
  return settle(scene::readYaml("ergotic: 1\nsections: {a: {rate: audio, start: equilibrium, "
                                "gravity: -9.81" +
                                    section + "}, k: {rate: gestural}}\n" + parts,
                                "rest.yaml"),
                kRates);
}

double placeOf(const Settled& of, const std::string& name) {
  const auto found = std::find_if(of.scene.mats.begin(), of.scene.mats.end(),
                                  [&](const scene::Mat& mat) { return mat.name == name; });
  return found->position.x();
}

/// Largest way of any module over half a second, m.
double farthestMotion(const scene::Scene& scene) {
  Player player(compile(scene, kRates, Precision::kDouble));
  double most = 0.0;
  player.ticks(1);
  std::vector<double> first;
  for (const auto& heard : player.heard) {
    first.push_back(heard.empty() ? 0.0 : heard.front());
  }
  player.ticks(1500);
  for (std::size_t c = 0; c < player.heard.size(); ++c) {
    for (const double x : player.heard[c]) {
      most = std::max(most, std::abs(x - first[c]));
    }
  }
  return most;
}

/// x = -m g/K, and a chain of three below each other: (n m) g/K more for each spring.
TEST(EquilibriumTest, WeightsHangWhereTheirSpringsHoldThem) {
  const Settled hung = settled(
      "mats: {g: {type: ground, section: a}, m: {type: mass, mass: 2, section: a},\n"
      "  n: {type: mass, mass: 3, section: a}, c: {type: cell, mass: 1, stiffness: 50, section: "
      "a}}\n"
      "lias: {k: {type: spring, between: [m, g], stiffness: 400},\n"
      "  l: {type: spring, between: [n, m], stiffness: 100}}\n"
      "outputs: {o: {at: n, quantity: position, channel: 1}, p: {at: c, quantity: position, "
      "channel: 2}}\n");
  const double first = -5.0 * kG / 400.0;
  EXPECT_NEAR(placeOf(hung, "m"), first, 1e-12);
  EXPECT_NEAR(placeOf(hung, "n"), first - 3.0 * kG / 100.0, 1e-12);
  // The matched cell as it is stepped.
  EXPECT_NEAR(placeOf(hung, "c"), -kG / 50.0, 1e-5 * kG / 50.0);
  EXPECT_LT(farthestMotion(hung.scene), 1e-11);
  EXPECT_THAT(hung.notes, testing::Contains(HasSubstr("section 'a' starts in equilibrium, up to")));
}

/// A ball falls from where it is written onto what is below it: f = K e^1.5 = m g.
TEST(EquilibriumTest, ABallLiesOnWhatIsBelowIt) {
  for (const char* height : {"-0.001", "0", "0.3", "20"}) {
    const Settled lying = settled(
        std::string("mats: {g: {type: ground, section: a}, b: {type: mass, mass: 0.1, x: ") +
        height +
        ", section: a}}\n"
        "lias: {k: {type: power_contact, between: [g, b], stiffness: 1e6, exponent: 1.5}}\n"
        "outputs: {o: {at: b, quantity: position, channel: 1}}\n");
    const double deep = std::pow(0.1 * kG / 1e6, 1.0 / 1.5);
    EXPECT_NEAR(placeOf(lying, "b"), -deep, 1e-9 * deep) << height;
    EXPECT_LT(farthestMotion(lying.scene), 1e-9) << height;
  }
}

/// A string that a ball lies on, through a place between two masses, is a string with a load.
TEST(EquilibriumTest, AStringGivesWayToWhatLiesOnIt) {
  const Settled loaded =
      settle(scene::readYaml(
                 "ergotic: 1\nsections: {a: {rate: audio, start: equilibrium}, "
                 "b: {rate: audio, start: equilibrium, gravity: -9.81}}\n"
                 "generators:\n  - {type: string, name: s, section: a, masses: 39, mass: 1e-3, "
                 "stiffness: 1000, to: [1, 0]}\n"
                 "mats: {b: {type: mass, mass: 0.01, x: 0.01, section: b}}\n"
                 "lias: {k: {type: contact, between: [s@0.3, b], stiffness: 1e4}}\n"
                 "outputs: {o: {at: s@0.3, quantity: position, channel: 1}}\n",
                 "rest.yaml"),
             kRates);
  // Tension 1000/40 N per unit of slope: F u (1 - u)/T.
  const double down = 0.01 * kG * 0.3 * 0.7 * 40.0 / 1000.0;
  EXPECT_NEAR(placeOf(loaded, "s.12"), -down, 1e-12);
  EXPECT_NEAR(placeOf(loaded, "b"), -down - 0.01 * kG / 1e4, 1e-12);
  EXPECT_LT(farthestMotion(loaded.scene), 1e-10);
}

/// A hardening spring, a table and a bar that bends under a constant pull.
TEST(EquilibriumTest, CurvedLawsAndBendsBalanceToo) {
  const Settled held = settled(
      "generators: [{type: bar, name: w, section: a, masses: 12, mass: 0.3, pitch: 131, ends: "
      "clamped, to: [0.4, 0]}]\n"
      "mats: {g: {type: ground, section: a}, m: {type: mass, mass: 1, section: a},\n"
      "  t: {type: mass, mass: 1, section: a}}\n"
      "lias: {q: {type: cubic, between: [m, g], stiffness: 10, nonlinearity: 1e5},\n"
      "  e: {type: table, between: [t, g], elastic: [[-1, -20], [0, 0], [1, 20]]}}\n"
      "outputs: {o: {at: m, quantity: position, channel: 1}, p: {at: w@0.5, quantity: position, "
      "channel: 2}, q: {at: t, quantity: position, channel: 3}}\n");
  const double x = placeOf(held, "m");
  EXPECT_NEAR(10.0 * x + 1e5 * x * x * x, -kG, 1e-9);
  EXPECT_NEAR(placeOf(held, "t"), -kG / 20.0, 1e-10);
  EXPECT_LT(placeOf(held, "w.6"), 0.0);
  EXPECT_LT(farthestMotion(held.scene), 1e-9);
}

/// What a hand holds at its zero, and what an agent holds where it begins.
TEST(EquilibriumTest, HandsAreWhereTheyBegin) {
  const Settled held = settled(
      "mats: {h: {type: slice, section: k, rest: 2 mm}, m: {type: mass, mass: 0.1, section: a}}\n"
      "lias: {k: {type: spring_damper, between: [m, h], stiffness: 300, damping: 1}}\n"
      "ports: {p: {mat: h, slice: 0, offset: 1 mm, position_scale: 2}}\n"
      "outputs: {o: {at: m, quantity: position, channel: 1}}\n");
  EXPECT_NEAR(placeOf(held, "m"), 2e-3 - 0.5e-3 - 0.1 * kG / 300.0, 1e-12);
}

/// Where all forces vanish at rest, or differ by rounding alone.
TEST(EquilibriumTest, RestWithoutForceIsFoundToo) {
  const auto at_rest = [](const std::string& parts) {
    return settle(
        scene::readYaml("ergotic: 1\nsections: {a: {rate: audio, start: equilibrium}}\n" + parts,
                        "rest.yaml"),
        kRates);
  };
  const Settled drawn = at_rest(
      "generators: [{type: string, name: s, section: a, masses: 30, mass: 1e-3, stiffness: 1000, "
      "to: [1, 0], pluck: {at: 0.3, height: 1 mm}}]\n");
  EXPECT_NEAR(placeOf(drawn, "s.9"), 0.0, 1e-13);
  const Settled pressed = at_rest(
      "mats: {g: {type: ground, section: a}, b: {type: mass, mass: 0.1, x: -0.3 mm, section: a}}\n"
      "lias: {k: {type: power_contact, between: [g, b], stiffness: 1e6, exponent: 1.5}}\n");
  EXPECT_NEAR(placeOf(pressed, "b"), 0.0, 1e-9);
  const Settled stiff = settled(
      "mats: {g: {type: ground, x: 30 mm, section: a}, b: {type: mass, mass: 5e-3, x: 30 mm, "
      "section: a}}\nlias: {k: {type: contact, between: [g, b], stiffness: 1e7}}\n");
  EXPECT_NEAR(placeOf(stiff, "b"), 0.03 - 5e-3 * kG / 1e7, 1e-14);
}

/// Played by its modes it rests where its masses and springs do.
TEST(EquilibriumTest, SectionsOfModesStartInItToo) {
  const Settled sagging = settled(
      "generators: [{type: string, name: s, section: a, masses: 39, mass: 1e-3, stiffness: 1000, "
      "damping: 0.01, to: [1, 0]}]\n"
      "outputs: {o: {at: s@0.5, quantity: position, channel: 1}}\n",
      ", modes: all");
  // m g j (N + 1 - j)/2K of a chain between fixed ends, in its middle.
  EXPECT_NEAR(placeOf(sagging, "s.20"), -1e-3 * kG * 20.0 * 20.0 / 2000.0, 1e-12);
  EXPECT_LT(farthestMotion(sagging.scene), 1e-12);
}

/// Beside a section with gravity a chaplet has a section of its own, which starts as that does.
TEST(EquilibriumTest, ChapletsStartInItToo) {
  const Settled held = settled(
      "mats: {h: {type: slice, coupling: chaplet, section: k, rest: 5 mm}, "
      "g: {type: ground, section: a}, m: {type: mass, mass: 0.1, section: a}}\n"
      "lias: {k: {type: spring, between: [m, g], stiffness: 1000},\n"
      "  l: {type: spring, between: [m, h], stiffness: 500}}\n"
      "ports: {p: {mat: h, slice: 0}}\n"
      "outputs: {o: {at: m, quantity: position, channel: 1}}\n");
  EXPECT_LT(farthestMotion(held.scene), 1e-9);
}

TEST(EquilibriumTest, SaysWhatNothingHolds) {
  const std::string falls = "mats: {m: {type: mass, mass: 1, section: a}}\n";
  EXPECT_THAT(complaintOf<TextError>([&] { settled(falls); }),
              HasSubstr("section 'a' has no equilibrium to start in: nothing holds module 'm' "
                        "against a force of 9.81 N"));
  EXPECT_THAT(complaintOf<TextError>([&] { settled(falls, ", geometry: line"); }),
              HasSubstr("allowed: in sections of geometry scalar"));
}

}  // namespace
}  // namespace ergotic::physics
