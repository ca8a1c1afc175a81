// SPDX-License-Identifier: BSD-3-Clause
// Springs that remember: what they lose of each swing, what they store, and that they give nothing.

#include "scene/laws/relaxing.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <cstdlib>
#include <random>

#include <Eigen/Dense>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

using scene::Relaxation;

/// (K + sum K_r q_r/e)/K of an elongation that goes round by so much in a step.
std::complex<double> answerOf(const std::vector<Relaxation>& branches, double angle) {
  const std::complex<double> z = std::polar(1.0, angle);
  std::complex<double> sum = 1.0;
  for (const Relaxation& branch : branches) {
    const double fade = std::exp(-kStep / branch.time);
    sum += branch.stiffness.factor * (1.0 - fade) * branch.time / kStep * (z - 1.0) / (z - fade);
  }
  return sum;
}

/// The same of continuous time.
std::complex<double> continuousAnswerOf(const std::vector<Relaxation>& branches, double hz) {
  std::complex<double> sum = 1.0;
  for (const Relaxation& branch : branches) {
    const std::complex<double> x(0.0, 2.0 * kPi * hz * branch.time);
    sum += branch.stiffness.factor * x / (1.0 + x);
  }
  return sum;
}

Lia& relaxing(SceneBuilder& b, int a, int c, double k, const std::vector<Relaxation>& branches) {
  Lia& lia = b.scene.lias[at(b.link(LiaType::kRelaxing, a, c, k))];
  lia.law.edit().relaxations = branches;
  return lia;
}

TEST(RelaxingTest, TheLossFactorOfEveryMaterialIsConstantOverWhatIsHeard) {
  for (const double eta : {0.001, 0.01, 0.02, 0.03, 0.1, 0.3, 0.5}) {
    const std::vector<Relaxation> branches = scene::relaxationsOf(eta, {1.0});
    for (double hz = 100.0; hz <= 8000.0; hz *= 1.02) {
      const std::complex<double> answer = continuousAnswerOf(branches, hz);
      EXPECT_NEAR(answer.imag() / answer.real() / eta, 1.0, 0.027) << eta << ", " << hz << " Hz";
    }
  }
}

/// Of a mass and three branches: the root with the positive angle of the recurrence of order five
/// that fits best.
std::complex<double> swingingPoleOf(const std::vector<double>& x) {
  constexpr Eigen::Index kOrder = 5;
  constexpr std::size_t kFirst = 2;  // the first step is made without links
  const auto rows = static_cast<Eigen::Index>(x.size() - kFirst) - kOrder;
  Eigen::MatrixXd before(rows, kOrder);
  Eigen::VectorXd after(rows);
  for (Eigen::Index n = 0; n < rows; ++n) {
    for (Eigen::Index k = 0; k <= kOrder; ++k) {
      (k < kOrder ? before(n, k) : after[n]) = x[kFirst + static_cast<std::size_t>(n + k)];
    }
  }
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(kOrder, kOrder);
  companion.topRightCorner(kOrder - 1, kOrder - 1).setIdentity();
  companion.bottomRows(1) = before.colPivHouseholderQr().solve(after).transpose();
  const Eigen::VectorXcd poles = companion.eigenvalues();
  return *std::max_element(poles.begin(), poles.end(),
                           [](const auto& a, const auto& b) { return a.imag() < b.imag(); });
}

/// A mass on such a spring loses eta/2 of its amplitude in each radian.
TEST(RelaxingTest, WhatSwingsOnItFadesAsTheLossFactorSays) {
  for (const double eta : {0.01, 0.02, 0.03}) {
    for (const double hz : {100.0, 145.0, 300.0, 600.0, 1200.0, 2400.0, 4800.0, 8000.0}) {
      const double angle = 2.0 * kPi * hz * kStep;
      const double kappa = 2.0 - 2.0 * std::cos(angle);
      const std::vector<Relaxation> unit = scene::relaxationsOf(eta, {1.0});
      const double k = 1e-3 * kRate * kRate * kappa / answerOf(unit, angle).real();
      SceneBuilder b;
      const int mass = b.mass(1e-3, 1e-3);
      relaxing(b, mass, b.ground(), k, scene::relaxationsOf(eta, {k}));
      b.hear(mass);
      Player player(b.scene, kEveryFrame);
      player.ticks(600);
      const std::complex<double> pole = swingingPoleOf(player.heard[0]);
      EXPECT_NEAR(std::arg(pole) / angle, 1.0, 1e-3) << hz;
      EXPECT_NEAR(-2.0 * std::log(std::abs(pole)) / std::arg(pole) / eta, 1.0, 0.05)
          << eta << ", " << hz << " Hz";
    }
  }
}

TEST(RelaxingTest, EachCycleLosesPiEtaKOfTheAmplitudeSquared) {
  constexpr double kStiffness = 2000.0;
  constexpr double kAmplitude = 1e-3;
  for (const double eta : {0.01, 0.03, 0.3}) {
    for (const int frames : {441, 210, 63, 30}) {
      const double angle = 2.0 * kPi / frames;
      SceneBuilder b;
      const std::vector<Relaxation> branches = scene::relaxationsOf(eta, {kStiffness});
      relaxing(b, b.driven(0), b.ground(), kStiffness, branches);
      Player player(b.scene, kEveryFrame);
      int n = 0;
      const auto play = [&](int cycles) {
        for (int k = 0; k < cycles * frames; ++k) {
          player.inputs[0] = kAmplitude * std::sin(angle * n++);
          player.tick();
        }
        return energiesOf(player).sections[0].dissipated;
      };
      const double before = play(2000 / frames + 1);
      const double loss = (play(20) - before) / 20.0;
      std::vector<Relaxation> unit = branches;
      for (Relaxation& each : unit) {
        each.stiffness.factor /= kStiffness;
      }
      const double area = kPi * kStiffness * kAmplitude * kAmplitude;
      // In steps the force of a cycle is a polygon: sin(angle)/angle of the ellipse.
      EXPECT_NEAR(loss / (area * answerOf(unit, angle).imag() * std::sin(angle) / angle), 1.0, 1e-6)
          << eta << ", " << frames;
      EXPECT_NEAR(loss / (area * continuousAnswerOf(unit, kRate / frames).imag()), 1.0, 0.02)
          << eta << ", " << frames;
    }
  }
}

/// The equations by themselves; then what they store, to rounding, is what the energy accounts say.
TEST(RelaxingTest, ItsMemoryIsThatOfTheEquationsAndTheEnergyAccountsKnowWhatIsInIt) {
  constexpr double kMass = 0.01;
  const std::vector<Relaxation> branches{{{300.0}, 2e-3}, {{900.0}, 1e-4}, {{4000.0}, 1e-5}};
  SceneBuilder b;
  const int mass = b.mass(kMass, 2e-3, 0.5);
  Lia& lia = relaxing(b, mass, b.ground(), 1000.0, branches);
  lia.damping = {0.05};
  lia.rest_length = 1e-3;
  Player player(b.scene, kEveryFrame);
  double x = 2e-3;
  double d = 0.5 * kStep;
  double force = 0.0;
  double lost = 0.0;
  double v_last = 0.0;
  std::array<double, 3> q{};
  for (int n = 0; n < 2000; ++n) {
    d -= kStep * kStep / kMass * force;
    x += d;
    const double e = x - 1e-3;
    double stored = 0.5 * 1000.0 * e * e;
    force = 1000.0 * e + 0.05 * d / kStep;
    for (std::size_t r = 0; r < 3; ++r) {
      const double fade = std::exp(-kStep / branches[r].time);
      const double follow = (1.0 - fade) * branches[r].time / kStep;
      const double last = q[r];
      const double k = branches[r].stiffness.factor;
      q[r] = fade * last + follow * d;
      force += k * q[r];
      stored += k * (1.0 + fade) / (4.0 * follow) * q[r] * q[r];
      lost += k * (1.0 - fade) / (4.0 * follow) * (q[r] + last) * (q[r] + last);
    }
    lost += 0.5 * d * 0.05 * (d + v_last) / kStep;
    v_last = d;
    player.tick();
    const Energies energies = energiesOf(player);
    ASSERT_NEAR(energies.sections[0].potential, stored, 1e-12 * 2e-3) << n;
    ASSERT_NEAR(energies.sections[0].dissipated, lost, 1e-12 * 2e-3) << n;
  }
  EXPECT_GT(lost, 1e-4);
}

/// Two to five masses on springs that remember. \param damping  the most of some of them, N s/m
SceneBuilder randomNet(unsigned seed, double damping) {
  std::mt19937 random(seed);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  SceneBuilder b;
  std::vector<int> ends{b.ground()};
  const int masses = std::uniform_int_distribution<int>(2, 5)(random);
  for (int i = 0; i < masses; ++i) {
    ends.push_back(b.mass(within(0.5, 2.0), within(-1.0, 1.0), within(-1e4, 1e4)));
  }
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const std::size_t other = std::uniform_int_distribution<std::size_t>(0, i - 1)(random);
    for (const std::size_t to : {other, std::size_t{0}}) {
      std::vector<Relaxation> branches;
      for (int r = std::uniform_int_distribution<int>(1, 3)(random); r > 0; --r) {
        branches.push_back({{within(0.0, 1e9)}, kStep * std::pow(10.0, within(-2.0, 4.0))});
      }
      relaxing(b, ends[i], ends[to], within(0.0, 1e9), branches).damping = {
          within(0.0, 1.0) < 0.3 ? within(0.0, damping) : 0.0};
    }
  }
  return b;
}

/// With masses with which lambda is so many times 4.
scene::Scene atTheLimit(SceneBuilder b, double share) {
  const double lambda = certify(b.scene, kEveryFrame).sections[0].lambda;
  for (scene::Mat& mat : b.scene.mats) {
    mat.mass.factor *= lambda / (4.0 * share);
  }
  return b.scene;
}

/// ERGOTIC_RELAXING asks for more.
unsigned nets() {
  const char* const asked = std::getenv("ERGOTIC_RELAXING");
  return asked == nullptr ? 2000 : static_cast<unsigned>(std::strtoul(asked, nullptr, 10));
}

/// The energy accounts count no energy in dampers, which by these sums store some.
TEST(RelaxingTest, NoRandomNetBelowTheLimitEverHasMoreEnergyThanBefore) {
  for (unsigned seed = 0; seed < nets(); ++seed) {
    const scene::Scene scene = atTheLimit(randomNet(seed, 0.0), 0.999);
    ASSERT_EQ(certify(scene, kEveryFrame).verdict, Verdict::kPassive) << seed;
    Player player(scene, kEveryFrame);
    player.tick();
    Energies energies = energiesOf(player);
    const double start = energies.stored;
    double stored = start;
    for (int n = 0; n < 300; ++n) {
      player.tick();
      player.instrument->readEnergies(energies);
      ASSERT_LE(energies.stored, stored + 1e-11 * start) << seed << ", frame " << n;
      ASSERT_LT(std::abs(energies.residual), 1e-10 * start) << seed << ", frame " << n;
      stored = energies.stored;
    }
  }
}

TEST(RelaxingTest, JustAboveTheLimitEveryRandomNetDiverges) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const scene::Scene scene = atTheLimit(randomNet(seed, 1e4), 1.001);
    EXPECT_EQ(certify(scene, kEveryFrame).verdict, Verdict::kUnstable) << seed;
    Player player(scene, kEveryFrame);
    player.tick();
    const double start = test::kineticEnergy(player);
    double most = 0.0;
    for (int n = 0; n < 200 && !(most > 1e3 * start); ++n) {
      player.ticks(500);
      most = test::kineticEnergy(player);
    }
    EXPECT_GT(most, 1e3 * start) << seed;
  }
}

TEST(RelaxingTest, OfADistanceOrAtAPointThatMovesNothingIsProven) {
  const auto verdict = [](const std::string& geometry, const std::string& ends) {
    const std::string text =
        "ergotic: 1\nparameters: {at: {value: 0.5, range: [0.2, 0.8]}}\n"
        "sections: {s: {geometry: " +
        geometry +
        "}}\ngenerators:\n"
        "  - {type: string, name: t, masses: 9, mass: 1e-3, stiffness: 1e3, to: [1, 0]}\nmats:\n"
        "  g: {type: ground}\n  p: {type: point, along: t, at: $at}\nlias:\n"
        "  l: {type: relaxing, between: " +
        ends + ", stiffness: 1e3, material: felt}\n";
    return certify(settle(scene::readYaml(text, "l.yaml"), {kRate, 14}).scene, {kRate, 14}).verdict;
  };
  EXPECT_EQ(verdict("scalar", "[t.3, g]"), Verdict::kPassive);
  EXPECT_EQ(verdict("line", "[t.3, g]"), Verdict::kUnproven);
  EXPECT_EQ(verdict("plane", "[t.3, g]"), Verdict::kUnproven);
  EXPECT_EQ(verdict("scalar", "[p, g]"), Verdict::kUnproven);
}

/// Where they pass one another their distance turns round, and with it what v says of it.
TEST(RelaxingTest, WhatPassesOneAnotherAlongALineMayGrow) {
  const scene::Scene scene =
      settle(scene::readYaml("ergotic: 1\nsections: {s: {geometry: line}}\nmats:\n"
                             "  a: {type: mass, mass: 0.003, at: 0.04}\n"
                             "  b: {type: mass, mass: 0.02, at: -0.01}\nlias:\n"
                             "  l: {type: relaxing, between: [a, b], stiffness: 1.2e6, "
                             "branches: [[1.5e5, 1.3e-3]]}\n",
                             "l.yaml"),
             kEveryFrame)
          .scene;
  EXPECT_EQ(certify(scene, kEveryFrame).verdict, Verdict::kUnproven);
  Player player(scene, kEveryFrame);
  player.tick();
  const double start = energiesOf(player).stored;
  player.ticks(44100);
  EXPECT_GT(test::kineticEnergy(player), 1e3 * start);
}

}  // namespace
}  // namespace ergotic::physics
