// SPDX-License-Identifier: BSD-3-Clause
#include "support/measure.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// M x'' + Z x' + K x = 0 through x(0) = x0 and x(-h) = x0 - v0 h: a module starts from its
/// position, and its velocity is how far it came in the step before.
class Oscillator {
 public:
  Oscillator(double m, double k, double z, double x0, double v0)
      : decay_(z / (2.0 * m)), square_(k / m - decay_ * decay_), free_(k == 0.0), x0_(x0) {
    const double before = x0 - v0 * kStep;
    const double w = std::sqrt(std::abs(square_));
    const double faded = std::exp(-decay_ * kStep) * before;
    if (free_) {
      other_ = (x0 - before) / (1.0 - std::exp(2.0 * decay_ * kStep));
    } else if (square_ > 0.0) {
      other_ = (x0 * std::cos(w * kStep) - faded) / std::sin(w * kStep);
    } else if (square_ < 0.0) {
      other_ = (x0 * std::cosh(w * kStep) - faded) / std::sinh(w * kStep);
    } else {
      other_ = (x0 - faded) / kStep;
    }
  }
  double operator()(double t) const {
    const double w = std::sqrt(std::abs(square_));
    const double fade = std::exp(-decay_ * t);
    if (free_) {
      return x0_ + other_ * (fade * fade - 1.0);
    }
    if (square_ > 0.0) {
      return fade * (x0_ * std::cos(w * t) + other_ * std::sin(w * t));
    }
    if (square_ < 0.0) {
      const double slow = std::exp((w - decay_) * t);
      const double fast = std::exp(-(w + decay_) * t);
      return 0.5 * (x0_ * (slow + fast) + other_ * (slow - fast));
    }
    return fade * (x0_ + other_ * t);
  }

 private:
  double decay_;
  double square_;
  bool free_;
  double x0_;
  double other_ = 0.0;
};

struct Case {
  const char* what;
  double m;
  double k;
  double z;
};
constexpr double kM = 0.002;
const Case kCases[] = {
    {"underdamped", kM, kM* std::pow(2.0 * kPi * 440.0, 2.0), 0.2},
    {"near half the rate", kM, kM* std::pow(2.0 * kPi * 20000.0, 2.0), 0.5},
    {"overdamped", kM, kM * 1e6, 4.0 * kM * 1e3},
    {"critically damped", kM, kM * 1e6, 2.0 * kM * 1e3},
    {"without a spring", kM, 0.0, 0.3},
};

void expectSamples(const SceneBuilder& b, const Case& c, double x0, double v0) {
  Player player(b.scene, {kRate, 10});
  player.ticks(1000);
  const Oscillator oscillator(c.m, c.k, c.z, x0, v0);
  for (int n = 0; n < 10000; n += 7) {
    ASSERT_NEAR(player.heard[0][at(n)], oscillator((n + 1) * kStep), 1e-12) << c.what << ", " << n;
  }
}

/// The medium adds to the damping before the match.
TEST(CellTest, MatchedOnesPassThroughTheSamplesOfTheContinuousOscillator) {
  for (const Case& c : kCases) {
    for (const double medium : {0.0, 0.75}) {
      SceneBuilder b;
      b.scene.sections[0].medium = {medium * c.z};
      const int cell = b.cell(c.m, c.k, (1.0 - medium) * c.z, 0.3, -20.0);
      b.scene.mats[at(cell)].matched = true;
      b.hear(cell);
      expectSamples(b, c, 0.3, -20.0);
    }
  }
}

TEST(CellTest, MassInAMediumSlowsDownAsTheContinuousOneDoes) {
  SceneBuilder b;
  b.scene.sections[0].medium = {0.3};
  b.hear(b.mass(kM, 0.3, -20.0));
  expectSamples(b, {"mass", kM, 0.0, 0.3}, 0.3, -20.0);
}

TEST(CellTest, MatchedOnesKeepThePitchThatPlainOnesMiss) {
  // Plain: 1200 log2(asin(w h/2) / (w h/2)) cents at 5 kHz.
  for (const bool matched : {false, true}) {
    SceneBuilder b;
    const int cell = b.cell(kM, kM * std::pow(2.0 * kPi * 5000.0, 2.0), 0.0, 1.0);
    b.scene.mats[at(cell)].matched = matched;
    b.hear(cell);
    Player player(b.scene, {kRate, 10});
    player.ticks(300);
    const double hz = std::arg(test::poleOf(player.heard[0])) / (2.0 * kPi) * kRate;
    if (matched) {
      EXPECT_NEAR(test::cents(hz, 5000.0), 0.0, 1e-8);
    } else {
      EXPECT_NEAR(test::cents(hz, 5000.0), 38.44, 0.01);
    }
  }
}

/// What fades within a thousandth of a step and hardly moves: e^(-sh) is 0, cosh(sh) infinite.
TEST(CellTest, CreepsHoweverMuchItIsDamped) {
  constexpr double kTiny = 1e-6;
  constexpr double kStiffness = 0.0375;
  constexpr double kX = 1e-3;
  for (const double damping : {30.0, 70.0, 1e4, 1e8}) {
    const double decay = damping / (2.0 * kTiny);
    const double fast = decay + std::sqrt(decay * decay - kStiffness / kTiny);
    for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
      SceneBuilder b;
      const int cell = b.cell(kTiny, kStiffness, damping);
      b.scene.mats[at(cell)].matched = true;
      b.scene.mats[at(cell)].position.x() = kX;
      b.hear(cell);
      Player player(compile(b.scene, {kRate, 10}, precision));
      player.ticks(1000);
      const double far = kX * std::exp(-kStiffness / kTiny / fast * 10000.0 * kStep);
      EXPECT_NEAR(player.heard[0].back(), far, kX * (precision == Precision::kFloat ? 1e-3 : 1e-9));
    }
  }
}

TEST(CellTest, RestsAtItsRestInAPlane) {
  SceneBuilder b;
  b.scene.sections[0].geometry = scene::Geometry::kPlane;
  const Case c = kCases[0];
  const int cell = b.cell(c.m, c.k, c.z);
  scene::Mat& mat = b.scene.mats[at(cell)];
  mat.matched = true;
  mat.rest = {2.0, -1.0, 0.0};
  mat.position = {2.1, -1.2, 0.0};
  b.hearAxes(cell);
  Player player(b.scene, {kRate, 10});
  player.ticks(100);
  const Oscillator x(c.m, c.k, c.z, 0.1, 0.0);
  const Oscillator y(c.m, c.k, c.z, -0.2, 0.0);
  for (int n = 0; n < 1000; ++n) {
    ASSERT_NEAR(player.heard[0][at(n)], 2.0 + x((n + 1) * kStep), 1e-12) << n;
    ASSERT_NEAR(player.heard[1][at(n)], -1.0 + y((n + 1) * kStep), 1e-12) << n;
  }
}

TEST(CellTest, YieldsToAConstantForceByItsOwnPull) {
  // h^2 f/(M kappa): f/K of a plain one, about (w h)^2/12 + Z h/2M more of a matched one.
  const double turn = 2.0 * kPi * 3000.0 * kStep;
  const double z = 1.0;
  for (const bool matched : {false, true}) {
    SceneBuilder b;
    const double k = kM * turn * turn / (kStep * kStep);
    const int cell = b.cell(kM, k, z);
    b.scene.mats[at(cell)].matched = matched;
    b.scene.mats[at(cell)].push.edit().force.x() = 2.0;
    b.hear(cell);
    Player player(b.scene, {kRate, 10});
    player.ticks(2000);
    const double fade = std::exp(-z / (2.0 * kM) * kStep);
    const double damped = std::sqrt(turn * turn - std::pow(std::log(fade), 2.0));
    const double kappa = 1.0 + fade * fade - 2.0 * fade * std::cos(damped);
    const double yields = 2.0 / k * (matched ? turn * turn / kappa : 1.0);
    EXPECT_NEAR(player.heard[0].back(), yields, 1e-12);
    EXPECT_NEAR(turn * turn / kappa - 1.0, turn * turn / 12.0 - std::log(fade), 1e-3);
  }
}

}  // namespace
}  // namespace ergotic::physics
