// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/settle.hpp"

#include "ergotic/physics/certificate/certify.hpp"
#include "physics/settling/pitch_pull.hpp"
#include "physics/settling/steps.hpp"
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A string of ten links in space, 1 m long, plucked to a height.
SceneBuilder spatialString(double rest_length, double height) {
  SceneBuilder b;
  b.scene.sections[0].geometry = scene::Geometry::kSpace;
  const int first = b.chain(9, 1e-4, 1000.0);
  for (int i = 0; i <= 10; ++i) {
    scene::Mat& mat = b.scene.mats[at(first + i)];
    mat.rest.x() = 0.1 * i;
    mat.position = mat.rest;
  }
  b.scene.mats[at(first + 5)].position.z() = height;
  for (scene::Lia& lia : b.scene.lias) {
    lia.rest_length = rest_length;
  }
  scene::StringInfo info;
  info.name = "string";
  info.first = first;
  info.count = 11;
  info.rest_length_ratio = rest_length / 0.1;
  b.scene.strings.push_back(info);
  return b;
}

TEST(SettleTest, PitchPullHasItsClosedForm) {
  EXPECT_NEAR(pitchPullCents(0.9, 0.01), 1.44, 0.005);
  EXPECT_NEAR(pitchPullCents(0.99, 0.01), 15.9, 0.05);
  EXPECT_EQ(pitchPullCents(0.0, 0.01), 0.0);
}

TEST(SettleTest, StringInSpaceIsToldWhatItGains) {
  const Settled settled = settle(spatialString(0.09, 0.0).scene, kRates);
  EXPECT_THAT(
      settled.notes,
      ElementsAre(HasSubstr("0.0144 cents higher at an amplitude of 0.1 % of its length, 1.44 at "
                            "1 %: geometry: scalar")));
  EXPECT_THAT(settle(spatialString(0.099, 0.0).scene, kRates).notes,
              Not(ElementsAre(HasSubstr("geometry: scalar"))))
      << "15.9 cents";
}

TEST(SettleTest, PluckAtTheStartDecidesIfThereIsOne) {
  EXPECT_THAT(settle(spatialString(0.09, 0.0144).scene, kRates).notes,
              ElementsAre(HasSubstr("geometry: scalar")));
  const Settled wide = settle(spatialString(0.09, 0.0145).scene, kRates);
  EXPECT_THAT(wide.notes, ElementsAre(HasSubstr("3.03 as it is plucked at the start")));
  EXPECT_THAT(wide.notes, Not(ElementsAre(HasSubstr("geometry: scalar"))));
  EXPECT_THAT(settle(spatialString(0.1, 0.0).scene, kRates).notes,
              ElementsAre(HasSubstr("is not stretched")));
}

TEST(SettleTest, ScalarStringsAreNotAdvised) {
  SceneBuilder b = spatialString(0.0, 0.0);
  b.scene.sections[0].geometry = scene::Geometry::kScalar;
  EXPECT_TRUE(settle(b.scene, kRates).notes.empty());
}

TEST(SettleTest, EveryOpenChoiceMakesASceneUnsettled) {
  const auto open = [](auto&& change) {
    SceneBuilder b;
    b.chain(4, 1e-4, 1000.0);
    b.scene.strings.push_back({});
    change(b.scene);
    return !scene::isSettled(b.scene);
  };
  EXPECT_FALSE(open([](scene::Scene&) {}));
  EXPECT_TRUE(open([](scene::Scene& s) { s.sections[1].automatic_rate = true; }));
  EXPECT_TRUE(open([](scene::Scene& s) { s.strings[0].frequency_hz = 110.0; }));
  EXPECT_TRUE(open([](scene::Scene& s) { s.lias[2].scheme = scene::Scheme::kAuto; }));
  EXPECT_TRUE(open([](scene::Scene& s) { s.lias[2].filtered = true; }));
}

TEST(SettleTest, SettledSceneIsLeftAlone) {
  SceneBuilder b;
  b.chain(4, 1e-4, 1000.0);
  b.scene.sections[0].automatic_rate = true;
  for (scene::Lia& lia : b.scene.lias) {
    lia.scheme = scene::Scheme::kAuto;
  }
  const Settled once = settle(b.scene, kRates);
  EXPECT_TRUE(scene::isSettled(once.scene));
  const Settled twice = settle(once.scene, kRates);
  EXPECT_TRUE(twice.notes.empty());
  EXPECT_EQ(twice.scene.sections[0].divisor, once.scene.sections[0].divisor);
}

constexpr double kMass = 0.01;

/// Adds a section that leaves its rate to the station.
int automatic(SceneBuilder& b) {
  scene::Section section;
  section.name = "free";
  section.automatic_rate = true;
  section.place = {50, 1};
  b.scene.sections.push_back(section);
  return static_cast<int>(b.scene.sections.size()) - 1;
}

/// Stiffness with which a mass on a fixed spring has h^2 K/M = lambda at a divisor.
double stiffness(double lambda, int divisor) {
  return lambda * kMass * kRate * kRate / (divisor * divisor);
}

/// One mass on a spring, lambda at the step of R frames.
SceneBuilder oscillator(double lambda, int divisor) {
  SceneBuilder b;
  const int s = automatic(b);
  const int mass = b.mass(kMass, 1e-3, 0.0, s);
  b.spring(mass, b.ground(0.0, s), stiffness(lambda, divisor));
  b.hear(mass);
  return b;
}

int chosen(const scene::Scene& scene, int ratio, int section = 2) {
  return settle(scene, {kRate, ratio}).scene.sections[at(section)].divisor;
}

TEST(AutomaticRateTest, HighestModeDecidesAtBothSidesOfTheThreshold) {
  EXPECT_EQ(chosen(oscillator(0.0399, 14).scene, 14), 14);
  EXPECT_EQ(chosen(oscillator(0.0401, 14).scene, 14), 7);
  EXPECT_EQ(chosen(oscillator(0.0401, 7).scene, 14), 2);
  EXPECT_EQ(chosen(oscillator(0.0401, 2).scene, 14), 1);
  EXPECT_EQ(chosen(oscillator(2.0, 1).scene, 14), 1) << "there is none faster";
}

TEST(AutomaticRateTest, MatchedCellsAreKeptBelowTheNyquistRateToo) {
  for (const double lambda : {0.039, 0.041}) {
    SceneBuilder b;
    const int s = automatic(b);
    b.cell(kMass, stiffness(lambda, 14), 0.0, 0.0, 0.0, s);
    b.scene.mats.back().matched = true;
    EXPECT_EQ(chosen(b.scene, 14), lambda < 0.04 ? 14 : 7);
  }
}

TEST(AutomaticRateTest, HeardDetuningIsThePredictedOne) {
  for (const double lambda : {0.002, 0.0399}) {
    const SceneBuilder b = oscillator(lambda, 14);
    const Settled settled = settle(b.scene, {kRate, 14});
    Player player(b.scene, {kRate, 14});
    player.ticks(4000);
    std::vector<double> x;
    for (int n = 0; n < 4000; ++n) {
      x.push_back(player.heard[0][at(14 * n)]);
    }
    const double heard = std::arg(test::poleOf(x));  // rad per step
    const double cents = 1200.0 * std::log2(heard / std::sqrt(lambda));
    EXPECT_GT(cents, 0.0);
    EXPECT_NEAR(cents, raisedCents(lambda), 1e-6);
    EXPECT_LT(cents, 3.0);
    ASSERT_EQ(settled.notes.size(), 1U);
    EXPECT_THAT(settled.notes[0],
                HasSubstr("built.yaml:50:1: note: section 'free' runs at 3.15e+03 Hz"));
  }
}

TEST(AutomaticRateTest, SectionsOfManyModesStayInTuneToo) {
  SceneBuilder b;
  const int s = automatic(b);
  int previous = b.ground(0.0, s);
  for (int i = 0; i < 8; ++i) {
    const int mass = b.mass(kMass, 0.0, 0.0, s);
    b.spring(previous, mass, stiffness(0.0099, 7));
    previous = mass;
  }
  EXPECT_EQ(chosen(b.scene, 14), 7) << "the bound of a chain is 4 times that of a link";
  b.scene.lias[4].stiffness = {stiffness(0.0401, 7)};
  EXPECT_EQ(chosen(b.scene, 14), 2);
}

TEST(AutomaticRateTest, SlicesStayGestural) {
  SceneBuilder b;
  const int s = automatic(b);
  const int hand = b.slice(0);
  b.scene.mats[at(hand)].section = s;
  b.spring(hand, b.mass(kMass, 0.0, 0.0, s), stiffness(0.1, 14));
  const Settled settled = settle(b.scene, {kRate, 14});
  EXPECT_TRUE(settled.scene.sections[at(s)].gestural);
  EXPECT_EQ(divisorOf(settled.scene.sections[at(s)], {kRate, 14}), 14);
}

TEST(AutomaticRateTest, CoupledSectionsHaveDivisorsThatDivide) {
  SceneBuilder b = oscillator(1e-4, 12);
  b.scene.sections[0].divisor = 4;
  const int mass = b.mass(kMass);
  b.spring(b.ground(), mass, stiffness(1e-4, 12));
  b.spring(0, mass, stiffness(0.0351, 6));
  // alone it could have 6, which is no multiple of 4 and does not divide it
  EXPECT_EQ(chosen(b.scene, 12), 4);
  b.scene.lias.pop_back();
  b.scene.lias[0].stiffness = {stiffness(0.0351, 6)};
  EXPECT_EQ(chosen(b.scene, 12), 6);
}

TEST(AutomaticRateTest, RateIsNotLoweredWhereTheVerdictWouldSuffer) {
  SceneBuilder b;
  const int s = automatic(b);
  const int bridge = b.mass(1.0, 0.0, 0.0, s);
  b.spring(bridge, b.ground(0.0, s), 100.0);
  const int first = b.chain(20, 1e-4, 0.9e-4 * kRate * kRate);
  // Across rates nothing is proven between the ends of its range.
  b.scene.parameters.push_back({"tie", 10.0, 5.0, 10.0, {}});
  b.scene.lias[at(b.spring(bridge, first + 1, 0.0))].stiffness = {1.0, 0};
  scene::Scene slow = b.scene;
  slow.sections[at(s)].automatic_rate = false;
  slow.sections[at(s)].divisor = 14;
  ASSERT_EQ(certify(slow, {kRate, 14}).verdict, Verdict::kUnproven);
  EXPECT_EQ(chosen(b.scene, 14), 1);
}

TEST(AutomaticRateTest, NobodyIsMovedWhoDidNotAsk) {
  SceneBuilder b = oscillator(1e-6, 14);
  b.scene.sections[2].automatic_rate = false;
  const Settled settled = settle(b.scene, {kRate, 14});
  EXPECT_EQ(settled.scene.sections[2].divisor, 1);
  EXPECT_TRUE(settled.notes.empty());
}

}  // namespace
}  // namespace ergotic::physics
