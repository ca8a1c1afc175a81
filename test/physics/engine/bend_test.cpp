// SPDX-License-Identifier: BSD-3-Clause
// Links of many ends: bars and plates swing as closed forms say, and are stepped as springs.

#include <algorithm>

#include <Eigen/Dense>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/network/linear_network.hpp"
#include "support/bars.hpp"
#include "support/measure.hpp"
#include "support/one_by_one.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using test::Bars;
using test::cents;
using Edge = Bars::Edge;

scene::Scene settledSceneOf(const std::string& text) {
  return settle(scene::readYaml(text, "bars.yaml"), kRates).scene;
}

/// h^2 w^2 / kappa of all modes, ascending.
std::vector<double> scaledModesOf(const scene::Scene& scene, double kappa) {
  std::vector<double> modes = LinearNetwork(Network(scene), 0).modes(400);
  for (double& mode : modes) {
    mode /= kRate * kRate * kappa;
  }
  return modes;
}

double sineOf(double t) {
  return 2.0 - 2.0 * std::cos(t);
}

/// x_n of a mode cos t n, sin t n, e^(p n), e^(-p n), with cosh p = 2 - cos t; or the second
/// difference x_(n-1) - 2 x_n + x_(n+1), over s(t).
Eigen::RowVector4d rowOf(double t, int n, int count, bool is_difference) {
  const double p = std::acosh(2.0 - std::cos(t));
  const double sign = is_difference ? -1.0 : 1.0;
  return {sign * std::cos(t * n), sign * std::sin(t * n), std::exp(p * (n - count)),
          std::exp(-p * n)};
}

/// 0 where a bar of `count` masses has a mode of the eigenvalue s(t)^2.
double determinantAt(double t, int count, Edge left, Edge right) {
  Eigen::Matrix4d rows;
  rows.row(0) = rowOf(t, left == Edge::kFree ? 1 : 0, count, left == Edge::kFree);
  rows.row(1) = rowOf(t, left == Edge::kClamped ? -1 : 0, count, left != Edge::kClamped);
  rows.row(2) = rowOf(t, count + (right == Edge::kFree ? 0 : 1), count, right == Edge::kFree);
  rows.row(3) = rowOf(t, count + (right == Edge::kClamped ? 2 : 1), count, right != Edge::kClamped);
  return rows.determinant();
}

TEST(BendTest, BarsHaveTheModesOfTheClosedFormHoweverTheirEndsAreHeld) {
  const std::pair<Edge, Edge> kEnds[] = {{Edge::kFree, Edge::kFree},
                                         {Edge::kClamped, Edge::kFree},
                                         {Edge::kClamped, Edge::kClamped},
                                         {Edge::kHinged, Edge::kFree},
                                         {Edge::kHinged, Edge::kClamped}};
  constexpr double kKappa = 0.2;
  for (const int count : {12, 24, 48}) {
    for (const auto& [left, right] : kEnds) {
      const std::vector<double> modes =
          scaledModesOf(settledSceneOf(Bars(kKappa).bar(count, left, right)), kKappa);
      const int rigid =
          (left == Edge::kFree ? 1 : 0) + (right == Edge::kFree && left != Edge::kClamped ? 1 : 0);
      ASSERT_EQ(static_cast<int>(modes.size()), count);
      for (int i = 0; i < count; ++i) {
        if (i < rigid) {
          EXPECT_LT(std::abs(modes[at(i)]), 1e-12);
          continue;
        }
        // s(t)^2 is the eigenvalue: between these two lies a root.
        const double t = std::acos(1.0 - 0.5 * std::sqrt(modes[at(i)]));
        const double off = 0.5e-9 * std::sqrt(modes[at(i)]) / (2.0 * std::sin(t));
        EXPECT_LT(
            determinantAt(t - off, count, left, right) * determinantAt(t + off, count, left, right),
            0.0)
            << count << ", mode " << i;
      }
    }
  }
}

/// Bars between hinges, and plates with hinged edges, have sines for modes.
TEST(BendTest, WhatHasHingedEdgesHasTheModesOfSines) {
  constexpr int kSide = 10;
  std::vector<double> expected;
  for (int j = 1; j <= kSide; ++j) {
    for (int k = 1; k <= kSide; ++k) {
      expected.push_back(
          std::pow(sineOf(j * kPi / (kSide + 1)) + sineOf(k * kPi / (kSide + 1)), 2.0));
    }
  }
  std::sort(expected.begin(), expected.end());
  const std::vector<double> modes =
      scaledModesOf(settledSceneOf(Bars(0.05).supportedPlate(kSide)), 0.05);
  ASSERT_EQ(modes.size(), expected.size());
  for (std::size_t i = 0; i < modes.size(); ++i) {
    EXPECT_NEAR(modes[i] / expected[i], 1.0, 1e-9) << i;
  }
}

/// Where bending along x does not bend it along y, a free plate has the modes of bars among its
/// own.
TEST(BendTest, AFreePlateThatDoesNotNarrowHasTheModesOfFreeBars) {
  constexpr int kSide = 12;
  const std::vector<double> plate =
      scaledModesOf(settledSceneOf(Bars(0.02).freePlate(kSide, 0.0)), 0.02);
  const std::vector<double> bar =
      scaledModesOf(settledSceneOf(Bars(0.02).bar(kSide, Edge::kFree, Edge::kFree)), 0.02);
  for (int i = 2; i < kSide; ++i) {
    const auto found = std::lower_bound(plate.begin(), plate.end(), bar[at(i)] * (1.0 - 1e-9));
    ASSERT_NE(found, plate.end());
    EXPECT_NEAR(*found / bar[at(i)], 1.0, 1e-9) << i;
  }
}

/// w L^2 sqrt(rho h/D) of the square plate with nu = 0.3, converged.
TEST(BendTest, AFreePlateIsInTuneWithThatOfTheLiterature) {
  constexpr double kConverged[] = {13.468, 19.596, 24.270, 34.801, 34.801, 61.09};
  constexpr struct {
    int side;
    double cents[6];
  } kRows[] = {{12, {5.5, 9.7, -1.0, 1.6, 1.6, -21.6}}, {18, {1.6, 4.3, -0.5, -0.4, -0.4, -9.2}}};
  for (const auto& row : kRows) {
    const std::vector<double> modes =
        scaledModesOf(settledSceneOf(Bars(0.01).freePlate(row.side, 0.3)), 0.01);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(modes[at(i)]), 1e-11) << "rigid";
    }
    for (int i = 0; i < 6; ++i) {
      const double lambda = row.side * row.side * std::sqrt(modes[at(3 + i)]);
      EXPECT_NEAR(cents(lambda, kConverged[i]), row.cents[i], 0.1) << row.side << ", " << i;
    }
  }
}

/// Displacements that neither move nor turn a body as a whole.
std::vector<double> bentAt(std::size_t count) {
  Eigen::MatrixXd rigid(count, 2);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    rigid.row(i) << 1.0, static_cast<double>(i);
  }
  x[1] = 1e-3;
  x -= rigid * rigid.householderQr().solve(x);
  return {x.begin(), x.end()};
}

TEST(BendTest, BarsSoundAtTheFrequenciesOfTheClosedForm) {
  constexpr int kCount = 24;
  constexpr double kKappa = 0.2;
  for (const Edge left : {Edge::kFree, Edge::kClamped}) {
    Bars bars(kKappa);
    bars.displacements = bentAt(kCount);
    const std::string text = bars.bar(kCount, left, Edge::kFree) +
                             "outputs: {o: {at: m24, quantity: velocity, channel: 1}}\n";
    const std::vector<double> modes = scaledModesOf(settledSceneOf(text), kKappa);
    for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
      Player player(scene::readYaml(text, "bars.yaml"), kRates, precision);
      player.ticks(8000);
      for (int i = 2; i < 8; ++i) {
        const double hz = std::asin(0.5 * std::sqrt(kKappa * modes[at(i)])) / kPi * kRate;
        const double heard = test::partialNear(player.heard[0], hz, kRate);
        EXPECT_LT(std::abs(cents(heard, hz)), 0.5) << i;
      }
    }
  }
}

TEST(BendTest, TheCertificateSeesOnePositiveLoadAndIsExact) {
  const auto verdict = [](const std::string& text) {
    return certify(settledSceneOf(text), kRates).verdict;
  };
  // The largest eigenvalues of long bars and large plates are 16 and 64 kappa.
  EXPECT_EQ(verdict(Bars(0.2499).bar(60, Edge::kFree, Edge::kFree)), Verdict::kPassive);
  EXPECT_EQ(verdict(Bars(0.2505).bar(60, Edge::kFree, Edge::kFree)), Verdict::kUnstable);
  EXPECT_EQ(verdict(Bars(0.0624).supportedPlate(16)), Verdict::kPassive);
  EXPECT_EQ(verdict(Bars(0.0650).supportedPlate(16)), Verdict::kUnstable);
  EXPECT_EQ(verdict(Bars(0.05).freePlate(14, 0.3)), Verdict::kPassive);
  EXPECT_EQ(verdict(Bars(0.12, ", damping: 5*$p").bar(60, Edge::kClamped, Edge::kFree)),
            Verdict::kUnstable);
  EXPECT_EQ(verdict(Bars(0.12, ", damping: 0.1*$p").bar(60, Edge::kClamped, Edge::kFree)),
            Verdict::kPassive);
}

/// What the springs of a bend give together is the force of the bend, bent at rest or not.
TEST(BendTest, ItsSpringsGiveItsForce) {
  const std::string text =
      "ergotic: 1\nsections: {s: {}}\nmats:\n"
      "  a: {type: mass, mass: 0.5, x: 0.01}\n  b: {type: mass, mass: 0.7, x: -0.02, v: 0.3}\n"
      "  c: {type: mass, mass: 0.2, x: 0.05, rest: 0.01}\n  d: {type: ground, x: 0.03}\n"
      "lias: {l: {type: bend, between: [a, b, c, d], weights: [1, -5, 1, 3],\n"
      "  stiffness: 300, damping: 20, rest_length: 0.004}}\noutputs:\n"
      "  a: {at: a, quantity: force, channel: 1}\n  b: {at: b, quantity: force, channel: 2}\n"
      "  c: {at: c, quantity: force, channel: 3}\n  d: {at: d, quantity: force, channel: 4}\n"
      "  xa: {at: a, quantity: position, channel: 5}\n"
      "  xb: {at: b, quantity: position, channel: 6}\n"
      "  xc: {at: c, quantity: position, channel: 7}\n"
      "  va: {at: a, quantity: velocity, channel: 8}\n"
      "  vb: {at: b, quantity: velocity, channel: 9}\n"
      "  vc: {at: c, quantity: velocity, channel: 10}\n";
  Player player(scene::readYaml(text, "bend.yaml"), kRates);
  player.ticks(20);
  constexpr double kWeights[] = {1.0, -5.0, 1.0, 3.0};
  for (std::size_t n = 0; n < player.heard[0].size(); ++n) {
    double e = 3.0 * 0.03 - 0.004;
    double v = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      e += kWeights[i] * player.heard[4 + i][n];
      v += kWeights[i] * player.heard[7 + i][n];
    }
    const double force = 300.0 * e + 20.0 * v;
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_NEAR(player.heard[i][n], -kWeights[i] * force, 1e-9 * 300.0) << n << ", end " << i;
    }
  }
}

TEST(BendTest, ItIsSteppedInABlockAsOneByOne) {
  for (const char* keys : {"", ", damping: 1e-3", ", damping: 2e-3*$p"}) {
    Bars bars(0.05, keys);
    bars.displacements = {0.0, 1e-3, -2e-3, 5e-4};
    const scene::Scene plate = settledSceneOf(bars.freePlate(12, 0.3));
    EXPECT_LT(test::differenceOneByOne(plate, Precision::kDouble, kRates, 100), 1e-11) << keys;
    const auto blocks = findBlocks(plate);
    ASSERT_EQ(blocks.size(), 1U);
    EXPECT_EQ(blocks[0].kind, Block::Kind::kLattice);
  }
}

/// Springs that lie side by side are one, so the inside of a plate has constant coefficients.
TEST(BendTest, ALargePlateHasConstantCoefficientsInside) {
  const auto blocks = findBlocks(settledSceneOf(Bars(0.05).freePlate(60, 0.3)));
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_THAT(describeBlock(blocks[0]), testing::HasSubstr("6 diagonals"));
}

TEST(BendTest, TheEnergyBalancesAndLossesAreTold) {
  for (const char* keys : {"", ", damping: 0.02", ", damping: 0.02*$p, rest_length: 1e-3"}) {
    Bars bars(0.1, keys);
    bars.displacements = bentAt(20);
    Player player(settledSceneOf(bars.bar(20, Edge::kClamped, Edge::kFree)), kRates);
    EXPECT_LT(imbalanceOf(player, 8000, 97), 1e-10) << keys;
    const Energies energies = energiesOf(player);
    EXPECT_EQ(energies.sections[0].dissipated > 0.0, *keys != '\0') << keys;
  }
}

/// One that is damped in a way of its own stays beside the modes of all others.
TEST(BendTest, ModesStandInForBendsInEitherPrecision) {
  const auto heard = [](const char* section, Precision precision) {
    Bars bars(0.1, ", damping: 0.02");
    bars.section = section;
    bars.displacements = bentAt(20);
    const std::string text =
        bars.bar(20, Edge::kClamped, Edge::kFree) +
        "  own: {type: bend, between: [m3, m4, m5], weights: [1, -2, 1], stiffness: 9e4,\n"
        "    damping: 3}\noutputs: {o: {at: m20, quantity: velocity, channel: 1}}\n";
    Player player(scene::readYaml(text, "bars.yaml"), kRates, precision);
    player.ticks(100);
    return player.heard[0];
  };
  const std::vector<double> plain = heard("{}", Precision::kDouble);
  const double most = std::abs(*std::max_element(
      plain.begin(), plain.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  for (const auto& [precision, rounding] :
       {std::pair(Precision::kDouble, 1e-9), std::pair(Precision::kFloat, 1e-2)}) {
    const std::vector<double> modal = heard("{modes: all}", precision);
    for (std::size_t n = 0; n < plain.size(); ++n) {
      ASSERT_NEAR(modal[n], plain[n], rounding * most) << n;
    }
  }
}

TEST(BendTest, InAPlaneItActsAlongEachCoordinateByItself) {
  const std::string lias =
      "lias: {l: {type: bend, between: [a, b, c], weights: [1, -3, 2], stiffness: 1e5},\n"
      "  k: {type: spring, between: [a, c], stiffness: 1e4}}\n"
      "outputs:\n  x: {at: b, quantity: position, channel: 1}\n";
  const std::string plane =
      "ergotic: 1\nsections: {s: {geometry: plane}}\nmats:\n"
      "  a: {type: mass, mass: 0.1, at: [0, 0], x: [0.01, -0.02]}\n"
      "  b: {type: mass, mass: 0.1, at: [0, 0], x: [0.02, 0.01]}\n"
      "  c: {type: mass, mass: 0.1, at: [0, 0], x: [0, 0.03]}\n" +
      lias + "  y: {at: b, quantity: position, axis: y, channel: 2}\n";
  Player both(scene::readYaml(plane, "plane.yaml"), kRates);
  both.ticks(100);
  constexpr const char* kStarts[2][3] = {{"0.01", "0.02", "0"}, {"-0.02", "0.01", "0.03"}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::string text = "ergotic: 1\nsections: {s: {}}\nmats:\n";
    for (std::size_t i = 0; i < 3; ++i) {
      text +=
          std::string("  ") + "abc"[i] + ": {type: mass, mass: 0.1, x: " + kStarts[axis][i] + "}\n";
    }
    Player one(scene::readYaml(text + lias, "line.yaml"), kRates);
    one.ticks(100);
    for (std::size_t n = 0; n < one.heard[0].size(); ++n) {
      ASSERT_NEAR(both.heard[axis][n], one.heard[0][n], 1e-12) << axis << ", " << n;
    }
  }
}

}  // namespace
}  // namespace ergotic::physics
