// SPDX-License-Identifier: BSD-3-Clause
// Sections of several rates, as they play and as the certificate sees them, against their
// equations.
#include <complex>

#include <Eigen/Dense>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "physics/certificate/linear_stepper.hpp"
#include "support/physics.hpp"

namespace ergotic::physics {
namespace {

/// A slow mass and a fast one on springs of their own, coupled; kg, samples, m.
struct Pair {
  int ratio = 14;
  double slow_mass = 1.0;
  double fast_mass = 0.3;
  double stiffness = 0.0;
  double damping = 0.0;
  double slow_spring = 0.0;
  double fast_spring = 0.0;

  /// K T^2 (1/M + 1/m) = 0.4: a tenth of the limit of a model that is slow throughout.
  static Pair tenthOfTheLimit(int ratio, double damping = 0.0) {
    Pair p;
    p.ratio = ratio;
    const double square = ratio * ratio;
    p.stiffness = 0.4 / (square * (1.0 / p.slow_mass + 1.0 / p.fast_mass));
    p.damping = damping / ratio;
    p.slow_spring = 0.05 / square;
    p.fast_spring = 0.07 / square;
    return p;
  }

  /// \param is  position of the slow one and of the fast one, and their steps in a period, m
  SceneBuilder scene(const Eigen::Vector4d& is = Eigen::Vector4d::Zero()) const {
    SceneBuilder b;
    const double k = kRate * kRate;  // from kg/sample^2 to N/m
    const int slow = b.mass(slow_mass, is[0], is[2] * kRate / ratio, SceneBuilder::kGestural);
    const int fast = b.mass(fast_mass, is[1], is[3] * kRate / ratio);
    b.spring(slow, fast, stiffness * k, damping * kRate);
    b.spring(slow, b.ground(0.0, SceneBuilder::kGestural), slow_spring * k);
    b.spring(fast, b.ground(), fast_spring * k);
    return b;
  }
};

/// Positions of both at the start of a period of the slower, and the momenta by which they came
/// there, in units of M/T: canonical, because the scheme follows from a discrete action.
using Phase = Eigen::Vector4d;  // X, x, P, p

Phase playedPeriod(const Pair& p, int unit, Phase& start) {
  SceneBuilder b = p.scene(Phase::Unit(unit));
  for (int mass = 0; mass < 2; ++mass) {
    b.hear(mass, mass);
    b.hear(mass, 2 + mass, Quantity::kVelocity);
  }
  Player player(b.scene, {kRate, p.ratio});
  player.ticks(2);
  const auto phaseAt = [&](int frame) {
    const auto& heard = player.heard;
    const double period = p.ratio / kRate;
    return Phase(heard[0][at(frame)], heard[1][at(frame)], heard[2][at(frame)] * period,
                 heard[3][at(frame)] * period * p.fast_mass / p.slow_mass);
  };
  start = phaseAt(0);
  return phaseAt(p.ratio);
}

/// One period of the slower mass, from what is heard of four unit starts.
Eigen::Matrix4d playedMatrix(const Pair& p) {
  Eigen::Matrix4d from;
  Eigen::Matrix4d to;
  for (int unit = 0; unit < 4; ++unit) {
    Phase start;
    to.col(unit) = playedPeriod(p, unit, start);
    from.col(unit) = start;
  }
  return to * from.inverse();
}

/// The equations, written out: the held position moves in the first of R fast steps, the slow mass
/// receives the mean.
Phase equations(const Pair& p, const Phase& from) {
  const double ratio = p.ratio;
  double x = from[1];
  double d = from[3] * p.slow_mass / (p.fast_mass * ratio);
  const double slow_step = from[2];
  double mean = 0.0;
  for (int m = 0; m < p.ratio; ++m) {
    const double up = m == 0 ? slow_step : 0.0;
    const double force = p.stiffness * (from[0] - x) + p.damping * (up - d);
    mean += force / ratio;
    d += (force - p.fast_spring * x) / p.fast_mass;
    x += d;
  }
  const double pull = mean + p.slow_spring * from[0];
  const double next_step = slow_step - ratio * ratio * pull / p.slow_mass;
  return {from[0] + next_step, x, next_step, d * ratio * p.fast_mass / p.slow_mass};
}

Eigen::Matrix4d matrixOfEquations(const Pair& p) {
  Eigen::Matrix4d matrix;
  for (int unit = 0; unit < 4; ++unit) {
    matrix.col(unit) = equations(p, Phase::Unit(unit));
  }
  return matrix;
}

std::vector<std::complex<double>> eigenvaluesOf(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  std::vector<std::complex<double>> values(solver.eigenvalues().begin(),
                                           solver.eigenvalues().end());
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
    return std::pair(std::arg(a), std::abs(a)) < std::pair(std::arg(b), std::abs(b));
  });
  return values;
}

void expectSameEigenvalues(const Eigen::MatrixXd& is, const Eigen::MatrixXd& should_be) {
  ASSERT_EQ(is.rows(), should_be.rows());
  const auto a = eigenvaluesOf(is);
  const auto b = eigenvaluesOf(should_be);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(std::arg(a[i]), std::arg(b[i]), 1e-10);
    EXPECT_NEAR(std::abs(a[i]), std::abs(b[i]), 1e-10);
  }
}

double symplecticDefect(const Eigen::Matrix4d& s) {
  Eigen::Matrix4d form = Eigen::Matrix4d::Zero();
  form.topRightCorner<2, 2>().setIdentity();
  form.bottomLeftCorner<2, 2>() = -Eigen::Matrix2d::Identity();
  return (s.transpose() * form * s - form).cwiseAbs().maxCoeff();
}

class TwoRatesTest : public testing::TestWithParam<int> {};

TEST_P(TwoRatesTest, PeriodIsTheMatrixOfTheEquations) {
  const Pair p = Pair::tenthOfTheLimit(GetParam());
  const Eigen::Matrix4d played = playedMatrix(p);
  const Eigen::Matrix4d expected = matrixOfEquations(p);
  EXPECT_LT((played - expected).cwiseAbs().maxCoeff(), 1e-10);
  expectSameEigenvalues(played, expected);
  for (const std::complex<double> value : eigenvaluesOf(expected)) {
    EXPECT_NEAR(std::abs(value), 1.0, 1e-10);
    EXPECT_GT(std::arg(value), -3.0) << "no pair on the real axis";
  }
}

TEST_P(TwoRatesTest, DampedPeriodOfHoldAndMeanIsTheMatrixOfTheEquations) {
  const Pair p = Pair::tenthOfTheLimit(GetParam(), 0.03);
  const Eigen::Matrix4d played = playedMatrix(p);
  EXPECT_LT((played - matrixOfEquations(p)).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT(played.eigenvalues().cwiseAbs().maxCoeff(), 1.0 - 1e-4);
}

TEST_P(TwoRatesTest, IsSymplectic) {
  const Pair p = Pair::tenthOfTheLimit(GetParam());
  EXPECT_LT(symplecticDefect(playedMatrix(p)), 1e-12);
}

TEST_P(TwoRatesTest, MonodromyTurnsAndShrinksAsTheEquationsSay) {
  for (const double damping : {0.0, 0.02}) {
    const Pair p = Pair::tenthOfTheLimit(GetParam(), damping);
    const auto matrix = monodromy(p.scene().scene, {kRate, p.ratio});
    expectSameEigenvalues(matrix, matrixOfEquations(p));
    EXPECT_LT(spectralRadius(matrix), damping > 0.0 ? 1.0 : 1.0 + 1e-12);
    EXPECT_GT(spectralRadius(matrix), damping > 0.0 ? 0.9 : 1.0 - 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Ratios, TwoRatesTest, testing::Values(4, 14, 44));

TEST(MonodromyTest, FirstUnstableCouplingIsThatOfTheEquations) {
  // Two free masses of one size, R = 14: unstable from u = K T^2 (1/M + 1/m) / 4 = 1.48 on.
  for (const double u : {1.46, 1.50}) {
    Pair p;
    p.fast_mass = 1.0;
    p.stiffness = 2.0 * u / 196.0;
    const auto matrix = monodromy(p.scene().scene, {kRate, p.ratio});
    EXPECT_EQ(spectralRadius(matrix) > 1.0 + 1e-6, u > 1.48) << u;
  }
}

TEST(MonodromyTest, OneMassAloneHasTheRootsOfItsStep) {
  // lambda^2 - (2 - kappa - zeta) lambda + (1 - zeta) = 0, R steps to a period.
  const double kappa = 0.3;
  const double zeta = 0.01;
  SceneBuilder b;
  b.spring(b.mass(1.0), b.ground(), kappa * kRate * kRate, zeta * kRate);
  const auto matrix = monodromy(b.scene, {kRate, 14});
  ASSERT_EQ(matrix.rows(), 2);
  EXPECT_NEAR(matrix.determinant(), std::pow(1.0 - zeta, 14.0), 1e-12);
  EXPECT_NEAR(spectralRadius(matrix), std::pow(1.0 - zeta, 7.0), 1e-12);
  const double angle = 14.0 * std::acos((2.0 - kappa - zeta) / (2.0 * std::sqrt(1.0 - zeta)));
  EXPECT_NEAR(matrix.trace(), 2.0 * std::pow(1.0 - zeta, 7.0) * std::cos(angle), 1e-10);
}

TEST(MonodromyTest, RigidMotionIsNoGrowth) {
  Pair p = Pair::tenthOfTheLimit(14);
  p.slow_spring = 0.0;
  p.fast_spring = 0.0;
  EXPECT_NEAR(spectralRadius(monodromy(p.scene().scene, {kRate, 14})), 1.0, 1e-12);
}

TEST(MonodromyTest, SectionsSlowerThanATickAreSteppedToTheirEnd) {
  Pair p = Pair::tenthOfTheLimit(28);
  SceneBuilder b = p.scene();
  b.scene.sections[SceneBuilder::kGestural].gestural = false;
  b.scene.sections[SceneBuilder::kGestural].divisor = 28;
  expectSameEigenvalues(monodromy(b.scene, {kRate, 14}), matrixOfEquations(p));
}

TEST(MonodromyTest, GoesOnUntilAllSectionsAreSteppedTogether) {
  const scene::Scene scene = scene::readYaml(
      "ergotic: 1\nsections:\n  two: {rate: {divisor: 4}}\n  three: {rate: {divisor: 6}}\n"
      "mats:\n  a: {type: mass, section: two, mass: 1}\n  b: {type: mass, section: three, mass: "
      "1}\n",
      "rates.yaml");
  EXPECT_EQ(LinearStepper(linearPart(scene), {kRate, 2}).ticks(), 6);
  EXPECT_EQ(LinearStepper(linearPart(scene), {kRate, 12}).ticks(), 1);
}

TEST(MonodromyTest, TakesTheLinearPartOnly) {
  Pair p = Pair::tenthOfTheLimit(14);
  const auto linear = monodromy(p.scene().scene, {kRate, 14});
  SceneBuilder b = p.scene();
  b.scene.sections[0].gravity.x() = -9.81;
  b.scene.mats[0].position.x() = 0.3;
  b.scene.mats[1].push.edit().velocity.x() = 2.0;
  b.scene.lias[0].type = LiaType::kCubic;
  b.scene.lias[0].law.edit().nonlinearity = {1e9};
  b.link(LiaType::kContact, 0, 1, kRate * kRate);
  b.link(LiaType::kSmoothBow, b.slice(0), 1, 0.0, 1.0);
  b.scene.lias.back().law.edit().width = {0.1};
  EXPECT_LT((monodromy(b.scene, {kRate, 14}) - linear).norm(), 1e-12);
}

/// An undamped string between a fixed end and a slow mass on a slow spring.
SceneBuilder stringOnSlowMass(int masses, double loss) {
  SceneBuilder b;
  const double mass = 1e-4;
  const double k = 0.99 * mass * kRate * kRate;
  const int slow = b.mass(0.049, 0.0, 0.0, SceneBuilder::kGestural);
  b.spring(slow, b.ground(0.0, SceneBuilder::kGestural), 2000.0, 1e3 * loss);
  int last = slow;
  for (int i = 0; i < masses; ++i) {
    const int next = b.mass(mass);
    b.spring(last, next, k);
    if (loss > 0.0) {
      b.spring(next, b.ground(), 0.0, loss * mass * kRate);
    }
    last = next;
  }
  b.spring(last, b.ground(), k);
  return b;
}

TEST(MonodromyTest, UndampedStringOnASlowMassGrowsAndIsCalledUnproven) {
  const SceneBuilder b = stringOnSlowMass(24, 0.0);
  const double growth = spectralRadius(monodromy(b.scene, {kRate, 14})) - 1.0;
  EXPECT_GT(growth, 1e-7);
  EXPECT_LT(growth, 1e-2);
  const Certificate c = certify(b.scene, {kRate, 14});
  EXPECT_EQ(c.verdict, Verdict::kUnproven);
  ASSERT_FALSE(c.findings.empty());
  EXPECT_THAT(c.findings.front(), HasSubstr("grows by a factor of exp("));
}

TEST(MonodromyTest, ALittleLossMakesThatStringProven) {
  const SceneBuilder b = stringOnSlowMass(24, 2e-3);
  EXPECT_LE(spectralRadius(monodromy(b.scene, {kRate, 14})), 1.0 + 1e-9);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
}

TEST(MonodromyTest, MediumThatFollowsAParameterIsProvenAtItsEndsOnly) {
  SceneBuilder b = stringOnSlowMass(24, 2e-3);
  b.scene.sections[SceneBuilder::kAudio].medium = {1e-3};
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
  b.scene.parameters.push_back({"medium", 1.0, 0.5, 1.0, {}});
  b.scene.sections[SceneBuilder::kAudio].medium = {1e-3, 0};
  const Certificate c = certify(b.scene, {kRate, 14});
  EXPECT_EQ(c.verdict, Verdict::kUnproven);
  EXPECT_THAT(c.findings, Contains(HasSubstr("not proven between")));
}

TEST(MonodromyTest, AGrowthOfThreeInAHundredMillionIsNotProven) {
  const auto growth = [](double loss) {
    return spectralRadius(monodromy(stringOnSlowMass(24, loss).scene, {kRate, 14})) - 1.0;
  };
  double less = 0.0;
  double more = 2e-3;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (less + more);
    (growth(middle) > 3e-8 ? less : more) = middle;
  }
  EXPECT_NEAR(growth(less), 3e-8, 1e-10);
  EXPECT_EQ(certify(stringOnSlowMass(24, less).scene, {kRate, 14}).verdict, Verdict::kUnproven);
}

TEST(MonodromyTest, BeyondThreeHundredMassesNothingIsProven) {
  const Certificate c = certify(stringOnSlowMass(300, 2e-3).scene, {kRate, 14});
  EXPECT_EQ(c.verdict, Verdict::kUnproven);
  ASSERT_FALSE(c.findings.empty());
  EXPECT_THAT(c.findings.front(), HasSubstr("301 masses"));
  EXPECT_THAT(c.findings.front(), HasSubstr("which proves nothing"));
}

}  // namespace
}  // namespace ergotic::physics
