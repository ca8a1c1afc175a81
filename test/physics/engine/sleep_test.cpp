// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include <Eigen/Dense>

#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/network/section_stiffness.hpp"
#include "physics/settling/sleep_bound.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A plucked string with losses, a hammer that comes back to it after half a second.
scene::Scene struckTwice(double sleep_energy, Scheme scheme = Scheme::kExplicit) {
  SceneBuilder b;
  const int first = b.chain(40, 1e-4, 900.0, 1e-3);
  for (int m = first + 1; m <= first + 40; ++m) {
    b.scene.mats[at(m)].type = scene::MatType::kCell;
    b.scene.mats[at(m)].damping = {4e-3};
  }
  b.scene.mats[at(first + 9)].push.edit().velocity.x() = 1.0;
  scene::Section other = b.scene.sections[0];
  other.name = "hammer";
  b.scene.sections.push_back(other);
  const int hammer = b.mass(5e-3, 0.5, -1.0, 2);
  const int l = b.link(scene::LiaType::kContact, first + 12, hammer, 2000.0);
  b.scene.lias[at(l)].law.edit().width = {0.0};
  b.scene.lias[at(l)].scheme = scheme;
  b.scene.sections[0].sleep_energy = sleep_energy;
  b.hear(first + 25);
  return b.scene;
}

TEST(SleeperTest, RestsBelowItsLimitAndWakesWhenStruck) {
  for (const Scheme scheme : {Scheme::kExplicit, Scheme::kEnergyStable}) {
    constexpr double kLimit = 1e-12;
    Player awake(struckTwice(0.0, scheme), {44100.0, 14});
    Player sleepy(struckTwice(kLimit, scheme), {44100.0, 14});
    awake.ticks(2500);
    sleepy.ticks(2500);
    const std::vector<double>& a = awake.heard[0];
    const std::vector<double>& s = sleepy.heard[0];
    // |x| <= sqrt(E L / (2 k)) for a chain of L links: where it falls asleep, and would have gone.
    const double bound = std::sqrt(kLimit * 41.0 / (2.0 * 900.0));
    double error = 0.0;
    double still = 0.0;
    for (std::size_t n = 1; n < a.size(); ++n) {
      error = std::max(error, std::abs(a[n] - s[n]));
      still += s[n] == s[n - 1] ? 1.0 : 0.0;
    }
    EXPECT_LE(error, 2.0 * bound);
    EXPECT_GT(error, bound * 1e-4) << "nothing was lost: it never slept";
    EXPECT_GT(still, 3000.0) << "it slept before the second stroke";
    EXPECT_GT(*std::max_element(s.begin() + 22050, s.end()), 1e-4) << "and woke by it";
  }
}

TEST(SleeperTest, CountsWhatItForgetsAsDissipated) {
  Player player(struckTwice(1e-8), {44100.0, 14});
  player.ticks(1000);
  const Energies e = energiesOf(player);
  EXPECT_EQ(e.sections[0].kinetic, 0.0);
  EXPECT_LT(e.sections[0].potential, 1e-8);
  EXPECT_NEAR(e.residual, 0.0, 1e-14);
}

/// What rests away from 0, on a spring to elsewhere, would have been thrown back there.
TEST(SleeperTest, StopsWhereItIs) {
  SceneBuilder b;
  b.scene.sections[0].sleep_energy = 1e-9;
  scene::Section other = b.scene.sections[0];
  other.name = "other";
  other.sleep_energy = 0.0;
  b.scene.sections.push_back(other);
  const int mass = b.mass(0.01, 0.01);
  const int wall = b.ground(0.01, 2);
  b.spring(mass, wall, 1e6, 1.0);
  b.hear(mass);
  Player player(b.scene, {44100.0, 14});
  player.ticks(100);
  EXPECT_EQ(player.heard[0].back(), 0.01);
  EXPECT_EQ(energiesOf(player).sections[0].kinetic, 0.0);
}

/// Near half the rate motion counts below 0: what stops there would keep up to E/(1 - lambda/4).
TEST(SleeperTest, StopsWhereItKeepsNoMoreThanItHad) {
  SceneBuilder b;
  b.scene.sections[0].sleep_energy = 1.0;
  scene::Section other = b.scene.sections[0];
  other.name = "other";
  other.sleep_energy = 0.0;
  b.scene.sections.push_back(other);
  const int mass = b.mass(1.0, 0.0, 1.0);
  b.spring(mass, b.ground(), 3.99 * kRate * kRate);
  b.link(scene::LiaType::kContact, mass, b.ground(0.0, 2), 1.0);  // is never reached
  b.scene.lias.back().law.edit().width = {-1.0};
  Player player(b.scene, {kRate, 1});
  const double start = energiesOf(player).stored;
  bool slept = false;
  for (int n = 0; n < 5000; ++n) {
    player.tick();
    const Energies now = energiesOf(player);
    slept = slept || now.sections[0].dissipated > 0.0;
    EXPECT_LE(now.stored, start * (1.0 + 1e-9));
  }
  EXPECT_TRUE(slept);
}

/// A hammer that comes back in time with the looks for quiet: what stopped bent woke without the
/// forces of its springs, and each step that was made without them gave up to half as much again.
TEST(SleeperTest, WakesWithTheForcesOfItsSprings) {
  const scene::Scene scene = scene::readYaml(
      "ergotic: 1\nsections: {a: {sleep: 1}, b: {}}\nmats:\n"
      "  ga: {type: ground, section: a}\n  gb: {type: ground, section: b}\n"
      "  m: {type: mass, section: a, mass: 1, x: 3.217270881e-05}\n"
      "  q: {type: mass, section: b, mass: 4.193950009, x: -0.0001590333231, v: 0.32555376}\n"
      "lias:\n"
      "  s: {type: spring_damper, between: [m, ga], stiffness: 1384536483, damping: 6.543973107}\n"
      "  t: {type: spring, between: [q, gb], stiffness: 4528944.578}\n"
      "  c: {type: contact, between: [q, m], stiffness: 1.903386234e+10}\n",
      "sleep.yaml");
  const Rates rates{kRate, 1};
  Player player(compile(settle(scene, rates).scene, rates, Precision::kDouble));
  const double start = energiesOf(player).stored;
  double most = 0.0;
  double slept = 0.0;
  for (int n = 0; n < 400000; ++n) {
    player.tick();
    const Energies now = energiesOf(player);
    most = std::max(most, now.stored);
    slept = now.sections[0].dissipated;
  }
  EXPECT_GT(slept, 0.1 * start);
  EXPECT_LE(most, start * (1.0 + 1e-9));
}

/// A fret that went on along a string that rests bent would be stretched by what nobody paid.
TEST(SleeperTest, PlacesWaitUntilWhatTheyLieOnWakes) {
  const scene::Scene scene = scene::readYaml(
      "ergotic: 1\nsections: {s: {sleep: 1e-3}, h: {}}\nmats:\n"
      "  gs: {type: ground, section: s}\n  gh: {type: ground, section: h}\n"
      "  guide: {type: cell, section: h, mass: 1e-12, stiffness: 4e-10, x: 0.45}\n"
      "  p: {type: point, along: q, at: 0.5, guide: {mat: guide, scale: 1}, range: [0.05, 0.95],\n"
      "      power: 1e-6}\n"
      "  k: {type: mass, section: h, mass: 0.01, x: 0.001, v: -1}\ngenerators:\n"
      "  - {type: string, name: q, section: s, masses: 20, mass: 0.01, stiffness: 100, loss: 0.3,\n"
      "     to: [0.65, 0]}\nlias:\n"
      "  fret: {type: spring, between: [p, gs], stiffness: 1e6}\n"
      "  back: {type: spring, between: [k, gh], stiffness: 10, rest_length: -0.001}\n"
      "  hit: {type: contact, between: [q.10, k], stiffness: 1000}\n",
      "fret.yaml");
  Player player(scene, {kRate, 14});
  player.tick();
  const double start = energiesOf(player).stored;
  for (int n = 0; n < 12000; ++n) {
    player.tick();
    ASSERT_LE(energiesOf(player).stored, 1.1 * start) << n;
  }
  EXPECT_GT(energiesOf(player).sections[0].dissipated, 0.5 * start);
}

// Its spring ends at a tap, which has handed on what it got in the step before.
TEST(SleeperTest, KeepsTheForcesOfSpringsAtTapsToo) {
  const scene::Scene scene = scene::readYaml(
      "ergotic: 1\nsections: {a: {rate: audio, sleep: 7.69182}, b: {rate: audio}}\nmats:\n"
      "  ga: {type: ground, section: a}\n  gb: {type: ground, section: b}\n"
      "  m: {type: mass, section: a, mass: 1, x: 2.62939e-05}\n"
      "  q: {type: mass, section: b, mass: 7.34179, x: -0.000370773, v: 0.178438}\n"
      "  t: {type: tap, of: m, weights: 1}\nlias:\n"
      "  s: {type: spring_damper, between: [t, ga], stiffness: 1.4950061e+09, damping: 0}\n"
      "  k: {type: spring, between: [q, gb], stiffness: 11138063}\n"
      "  c: {type: contact, between: [q, m], stiffness: 4.65432e+09}\n",
      "tap.yaml");
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    constexpr double kStartJ = 1.8;
    Player player(compile(settle(scene, {44100.0, 14}).scene, {44100.0, 14}, precision));
    for (int n = 0; n < 10000; ++n) {
      player.tick();
      ASSERT_LE(kineticEnergy(player), kStartJ) << n;
    }
  }
}

/// As found by an attack: what is hit again and again sleeps in between.
std::string hitAgain(const std::string& more, const std::string& lower = "m") {
  return "ergotic: 1\nsections: {a: {rate: audio, sleep: 0.678382}, b: {rate: audio}}\nmats:\n"
         "  ga: {type: ground, section: a}\n  gb: {type: ground, section: b}\n"
         "  m: {type: mass, section: a, mass: 1, x: 7.27409e-05}\n"
         "  q: {type: mass, section: b, mass: 6.53988, x: -0.000161748, v: 1.04781}\n"
         "  t: {type: tap, of: m, weights: 1}\n"
         "lias:\n  s: {type: spring_damper, between: [" +
         lower +
         ", ga], stiffness: 1.1342883e+09, damping: 0}\n"
         "  k: {type: spring, between: [q, gb], stiffness: 6407260.7}\n"
         "  c: {type: contact, between: [q, m], stiffness: 3.55381e+10}\n" +
         more;
}
const std::string kFedIn = "inputs: {i: {mat: m, quantity: force, channel: 1}}\n";

TEST(SleeperTest, KeepsTheForcesOfSpringsWhereForceIsFedIn) {
  constexpr double kStartJ = 8.2;
  const scene::Scene scene =
      settle(scene::readYaml(hitAgain(kFedIn), "fed.yaml"), {kRate, 14}).scene;
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    Player silent(compile(scene, {kRate, 14}, precision));
    for (int n = 0; n < 10000; ++n) {
      silent.tick();
      ASSERT_LE(kineticEnergy(silent), kStartJ) << n;
    }
  }
}

/// The same with so many strings of one mass that they are stepped as a block.
std::string hitAgainInABlock(const std::string& more, bool sleeps) {
  std::string text = std::string("ergotic: 1\nsections: {a: {rate: audio") +
                     (sleeps ? ", sleep: 0.678382" : "") + "}, b: {rate: audio}}\ngenerators:\n";
  for (int i = 0; i < 8; ++i) {
    text += "  - {type: string, name: s" + std::to_string(i) +
            ", section: a, masses: 1, mass: 1, stiffness: 567144150, to: [0.1, 0]" +
            (i == 0 ? ", pluck: {at: 0.5, height: 7.27409e-05}}\n" : "}\n");
  }
  return text +
         "mats:\n  gb: {type: ground, section: b}\n"
         "  q: {type: mass, section: b, mass: 6.53988, x: -0.000161748, v: 1.04781}\n"
         "lias:\n  k: {type: spring, between: [q, gb], stiffness: 6407260.7}\n"
         "  c: {type: contact, between: [q, s0.1], stiffness: 3.55381e+10}\n" +
         more;
}

TEST(SleeperTest, KeepsTheForcesOfSpringsInABlock) {
  const Rates rates{kRate, 15};
  for (const char* const more : {"", "inputs: {i: {mat: s0.1, quantity: force, channel: 1}}\n"}) {
    Player sleepy(
        compile(settle(scene::readYaml(hitAgainInABlock(more, true), "a.yaml"), rates).scene, rates,
                Precision::kDouble));
    Player awake(
        compile(settle(scene::readYaml(hitAgainInABlock(more, false), "a.yaml"), rates).scene,
                rates, Precision::kDouble));
    sleepy.tick();
    awake.tick();
    const double start = energiesOf(awake).stored;
    double most = 0.0;
    double slept = 0.0;
    for (int n = 0; n < 4000; ++n) {
      sleepy.tick();
      const Energies now = energiesOf(sleepy);
      most = std::max(most, now.stored);
      slept = now.sections[0].dissipated;
      ASSERT_NEAR(now.residual, 0.0, 1e-6 * start) << n;
    }
    EXPECT_GT(slept, 0.0) << "it never slept";
    EXPECT_LE(most, start * (1.0 + 1e-9));
  }
}

TEST(SleeperTest, RefusesForceBesideSpringsAtTaps) {
  const scene::Scene scene =
      settle(scene::readYaml(hitAgain(kFedIn, "t"), "fed.yaml"), {kRate, 14}).scene;
  EXPECT_THAT(complaintOf([&] {
                compile(scene, {kRate, 14}, Precision::kDouble);
              }),
              HasSubstr("not both"));
}

TEST(SleeperTest, RefusesASectionThatDoesNotRestAtZero) {
  scene::Scene scene = struckTwice(1e-9);
  scene.sections[0].gravity.x() = -9.81;
  EXPECT_THROW(compile(scene, {44100.0, 14}, Precision::kDouble), Exception);
}

TEST(SleepBoundTest, ChainHasItsClosedForm) {
  const double k = 2500.0;
  for (const int masses : {1, 9, 100, 999}) {
    SceneBuilder b;
    b.chain(masses, 1e-4, k);
    b.scene.sections[0].sleep_energy = 3e-12;
    const double links = masses + 1;
    // the middle of an even number of links; of an odd one, a little less
    const double middle = std::floor(links / 2.0) * std::ceil(links / 2.0) / (links * k);
    EXPECT_NEAR(sleepingDistance(Network(b.scene), 0) / std::sqrt(2.0 * 3e-12 * middle), 1.0, 1e-9);
    EXPECT_LE(sleepingDistance(Network(b.scene), 0),
              std::sqrt(3e-12 * links / (2.0 * k)) * (1.0 + 1e-9));
  }
}

TEST(SleepBoundTest, IsTheDiagonalOfTheInverseForAnyNetwork) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> stiffness(0.1, 10.0);
  for (int round = 0; round < 30; ++round) {
    SceneBuilder b;
    const int ground = b.ground();
    std::vector<int> masses;
    for (int i = 0; i < 40; ++i) {
      masses.push_back(b.mass(1.0));
      const int other = static_cast<int>(random() % static_cast<unsigned>(masses.size()));
      b.spring(i == 0 ? ground : other, masses.back(), stiffness(random));
    }
    for (int i = 0; i < 60; ++i) {
      const auto any = [&] { return masses[random() % masses.size()]; };
      const int a = any();
      const int c = any();
      if (a != c) {
        b.spring(a, c, stiffness(random));
      }
    }
    const Eigen::SparseMatrix<double> k = stiffnessOf(Network(b.scene), 0);
    const Eigen::MatrixXd inverse = Eigen::MatrixXd(k).inverse();
    EXPECT_NEAR(largestCompliance(k) / inverse.diagonal().maxCoeff(), 1.0, 1e-10);
  }
}

TEST(SleepBoundTest, NoMotionOfThatEnergyGoesFurther) {
  SceneBuilder b;
  b.chain(12, 1e-4, 800.0);
  b.scene.lias[3].stiffness = {50.0};
  const double energy = 1e-9;
  b.scene.sections[0].sleep_energy = energy;
  const double bound = sleepingDistance(Network(b.scene), 0);
  const Eigen::MatrixXd k(stiffnessOf(Network(b.scene), 0));
  double furthest = 0.0;
  for (int i = 0; i < 12; ++i) {
    // pulled at one module: the shape that goes furthest there for its energy
    Eigen::VectorXd x = k.ldlt().solve(Eigen::VectorXd::Unit(12, i));
    x *= std::sqrt(energy / (0.5 * x.dot(k * x)));
    furthest = std::max(furthest, x.cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(furthest / bound, 1.0, 1e-9) << "and one reaches it";
}

TEST(SleepBoundTest, StretchedStringIsHeldAcrossByItsTension) {
  // one mass between two links of length 1, rest length 0.75: along 2 k, across 2 k (1 - 0.75)
  SceneBuilder b;
  b.scene.sections[0].geometry = scene::Geometry::kPlane;
  const int first = b.chain(1, 1e-4, 100.0);
  for (int i = 0; i < 3; ++i) {
    b.scene.mats[at(first + i)].rest.x() = i;
  }
  for (scene::Lia& lia : b.scene.lias) {
    lia.rest_length = 0.75;
  }
  const Eigen::MatrixXd k(stiffnessOf(Network(b.scene), 0));
  EXPECT_NEAR(k(0, 0), 200.0, 1e-9);
  EXPECT_NEAR(k(1, 1), 50.0, 1e-9);
  EXPECT_NEAR(largestCompliance(Eigen::MatrixXd(k).sparseView()), 1.0 / 50.0, 1e-12);
}

TEST(SleepBoundTest, CellsAreHeldInEveryCoordinateThatMoves) {
  SceneBuilder b;
  b.scene.sections[0].geometry = scene::Geometry::kSpace;
  b.cell(1e-3, 40.0, 0.0);
  b.cell(1e-3, 10.0, 0.0);
  const Eigen::MatrixXd k(stiffnessOf(Network(b.scene), 0));
  EXPECT_EQ(k.rows(), 6);
  EXPECT_NEAR(largestCompliance(k.sparseView()), 1.0 / 10.0, 1e-12);
  b.scene.parameters.push_back({"k", 1.0, 0.2, 5.0, {}});
  b.scene.mats[0].stiffness = {40.0, 0};
  EXPECT_NEAR(largestCompliance(stiffnessOf(Network(b.scene), 0)), 1.0 / 8.0, 1e-12);
}

TEST(SleepBoundTest, NoteComparesWithTheStart) {
  SceneBuilder b;
  const int first = b.chain(9, 1e-4, 2000.0);
  b.scene.mats[at(first + 5)].position.x() = 1e-3;
  b.scene.sections[0].sleep_energy = 2e-3 * 1e-6;
  b.hear(first + 2);
  const Settled settled = settle(b.scene, {44100.0, 14});
  ASSERT_EQ(settled.notes.size(), 1U);
  // two springs of 2000 N/m stretched by 1 mm: 2e-3 J
  EXPECT_THAT(settled.notes[0], HasSubstr("sleeps below 2e-09 J"));
  EXPECT_THAT(settled.notes[0], HasSubstr("at most 2.24e-06 m"));
  EXPECT_THAT(settled.notes[0], HasSubstr("1e-06 of its energy at the start (-60 dB)"));
}

TEST(SleepBoundTest, NothingIsPromisedOfWhatIsFree) {
  SceneBuilder b;
  b.chain(5, 1e-4, 100.0);
  b.mass(1.0);
  b.scene.sections[0].sleep_energy = 1e-9;
  EXPECT_TRUE(std::isinf(sleepingDistance(Network(b.scene), 0)));
  const Settled settled = settle(b.scene, {44100.0, 14});
  EXPECT_THAT(settled.notes.at(0), HasSubstr("has no bound"));
}

}  // namespace
}  // namespace ergotic::physics
