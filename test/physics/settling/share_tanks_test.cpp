// SPDX-License-Identifier: BSD-3-Clause
// Cubic links that harden one body share one tank.
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "constants.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

constexpr int kLinks = 17;
constexpr double kStringHz = 150.0;

/// A string of 16 masses at 150 Hz that hardens link by link, and a hammer with a stiff felt in a
/// hand.
std::string hardString(const std::string& cubic, const std::string& felt = "") {
  std::string text =
      "ergotic: 1\ngestural_rate: 3675\nsections: {a: {rate: audio, medium: 0.0027631}, b: {rate: "
      "audio}, k: {rate: gestural}}\n"
      "generators:\n  - {type: string, name: s, section: a, masses: 16, mass: 0.0001, stiffness: "
      "2608.41486, damping: 1e-4, to: [0.65, 0]}\n"
      "agents:\n  hand: {mat: h, section: k, stiffness: 1500, damping: 1.5, period: 1, points: "
      "[[0, "
      "-0.001], [0.02, -0.001], [0.028, 0.006], [0.04, -0.001]]}\n"
      "mats: {h: {type: mass, section: b, mass: 0.002, x: -0.001}}\nlias:\n"
      "  f: {type: felt, between: [h, s.4], stiffness: 3e8, exponent: 2.5, damping: 0.2" +
      felt + "}\n";
  for (int c = 0; c < kLinks; ++c) {
    text += "  c" + std::to_string(c) + ": {type: cubic, between: [s." + std::to_string(c) +
            ", s." + std::to_string(c + 1) + "], nonlinearity: 2e10" + cubic + "}\n";
  }
  return text + "outputs: {o: {at: s.7, quantity: velocity, channel: 1}}\n";
}

Settled settledAt(const std::string& text, double rate_hz) {
  const scene::Scene scene = scene::readYaml(text, "hard.yaml");
  return settle(scene, chooseRates(scene, rate_hz));
}

int tanksIn(const std::string& text) {
  return static_cast<int>(settledAt(text, kRate).scene.tanks.size());
}

/// The phase of a sound at 150 Hz, through a window of 80 ms from `from` on, s.
double phaseAt(const std::vector<double>& heard, double from, double rate_hz) {
  const double count = 0.08 * rate_hz;
  std::complex<double> sum;
  for (double i = 0.0; i < count; ++i) {
    const double frame = std::round(from * rate_hz) + i;
    sum += (1.0 - std::cos(2.0 * kPi * i / count)) * heard.at(static_cast<std::size_t>(frame)) *
           std::polar(1.0, -2.0 * kPi * kStringHz * frame / rate_hz);
  }
  return std::arg(sum);
}

/// What a blow sounds like.
struct Blow {
  double hz;    // mean, about 0.1 s after it began
  double loud;  // rms, m/s
};

Blow blow(const std::string& text, double rate_hz) {
  const scene::Scene scene = scene::readYaml(text, "hard.yaml");
  const Rates rates = chooseRates(scene, rate_hz);
  Player player(compile(settle(scene, rates).scene, rates, Precision::kDouble));
  for (int n = 0; n < 0.5 * rates.gesturalHz(); ++n) {
    for (double& position : player.positions) {
      position = player.instrument->scene().agents[0].at(n / rates.gesturalHz());
    }
    player.tick();
  }
  const std::vector<double>& heard = player.heard.at(0);
  const double turned = phaseAt(heard, 0.07, rate_hz) - phaseAt(heard, 0.05, rate_hz);
  double sum = 0.0;
  for (const double v : heard) {
    sum += v * v;
  }
  return {kStringHz + std::remainder(turned, 2.0 * kPi) / (2.0 * kPi * 0.02),
          std::sqrt(sum / static_cast<double>(heard.size()))};
}

double centsAbove(double hz, double of) {
  return 1200.0 * std::log2(hz / of);
}

TEST(ShareTanksTest, HardeningLinksOfOneBodyShareATank) {
  const Settled settled = settledAt(hardString(", stiffness: 0"), kRate);
  ASSERT_EQ(settled.scene.tanks.size(), 1U);
  EXPECT_EQ(settled.scene.tanks[0].name, "c0.tank");
  EXPECT_THAT(settled.notes, Contains(HasSubstr("link 'c0' and 16 more harden one body and share "
                                                "one tank of energy")));
}

TEST(ShareTanksTest, WhatTheUserChoseStaysAsItIs) {
  EXPECT_EQ(tanksIn(hardString(", stiffness: 0, scheme: energy_stable")), 0);
  EXPECT_EQ(tanksIn(hardString(", stiffness: 0, scheme: explicit")), 0);
  EXPECT_EQ(tanksIn(hardString(", stiffness: 0, tank: mine")), 1);
}

TEST(ShareTanksTest, TheLinearPartBecomesASpringBeside) {
  const scene::Scene scene = settledAt(hardString(", stiffness: 10, damping: 1e-5"), kRate).scene;
  const auto named = [&](const std::string& name) {
    return std::find_if(scene.lias.begin(), scene.lias.end(),
                        [&](const scene::Lia& lia) { return lia.name == name; });
  };
  ASSERT_NE(named("c3.linear"), scene.lias.end());
  EXPECT_EQ(named("c3.linear")->stiffness.factor, 10.0);
  EXPECT_EQ(named("c3.linear")->damping.factor, 1e-5);
  EXPECT_EQ(named("c3.linear")->scheme, scene::Scheme::kExplicit);
  EXPECT_EQ(named("c3")->stiffness.factor, 0.0);
  EXPECT_EQ(named("c3")->tank, 0);
}

TEST(ShareTanksTest, BodiesThatOnlyTouchHaveATankEach) {
  const std::string two =
      "ergotic: 1\nsections: {a: {}}\nmats:\n  g: {type: ground}\n"
      "  m0: {type: mass, mass: 0.01}\n  m1: {type: mass, mass: 0.01}\n"
      "  n0: {type: mass, mass: 0.01}\n  n1: {type: mass, mass: 0.01}\nlias:\n"
      "  a0: {type: cubic, between: [m0, g], stiffness: 100, nonlinearity: 1e6}\n"
      "  a1: {type: cubic, between: [m0, m1], stiffness: 100, nonlinearity: 1e6}\n"
      "  b0: {type: cubic, between: [n0, g], stiffness: 100, nonlinearity: 1e6}\n"
      "  b1: {type: cubic, between: [n0, n1], stiffness: 100, nonlinearity: 1e6}\n"
      "  touch: {type: contact, between: [m1, n1], stiffness: 1000}\n"
      "outputs: {o: {at: m0, quantity: velocity, channel: 1}}\n";
  EXPECT_EQ(tanksIn(two), 2);
}

/// Reference: explicit, at four times the rate. While each link was charged as if all others on its
/// masses pushed as it does, those with a tank each took a third more from the hammer, and the
/// pitch rose 6 cents too far.
TEST(ShareTanksTest, AHammerInAHandGivesAsMuchAsAtFourTimesTheRate) {
  const Blow right =
      blow(hardString(", stiffness: 0, scheme: explicit", ", scheme: explicit"), 4.0 * kRate);
  const Blow shared = blow(hardString(", stiffness: 0"), kRate);
  const Blow one_by_one = blow(hardString(", stiffness: 0, scheme: energy_stable"), kRate);
  EXPECT_LT(std::abs(centsAbove(shared.hz, right.hz)), 3.0);
  EXPECT_LT(std::abs(centsAbove(one_by_one.hz, right.hz)), 1.5);
  EXPECT_NEAR(shared.loud / right.loud, 1.0, 0.06);
  EXPECT_NEAR(one_by_one.loud / right.loud, 1.0, 0.01);
}

}  // namespace
}  // namespace ergotic::physics
