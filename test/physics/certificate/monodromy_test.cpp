// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/monodromy.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "ergotic/physics/certificate/certify.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::physics {
namespace {

using test::SceneBuilder;

constexpr double kRate = 44100.0;

/// A slow mass on a slow spring, coupled to a fast mass on a fast spring. h = 1.
struct Pair {
  int ratio = 14;
  double slow_mass = 1.0;
  double fast_mass = 0.3;
  double stiffness = 0.0;
  double damping = 0.0;
  double slow_spring = 0.0;
  double fast_spring = 0.0;

  SceneBuilder scene() const {
    SceneBuilder b;
    const double k = kRate * kRate;  // from kg/sample^2 to N/m
    const int slow = b.mass(slow_mass, 0.0, 0.0, SceneBuilder::kGestural);
    const int fast = b.mass(fast_mass);
    b.spring(slow, fast, stiffness * k, damping * kRate);
    b.spring(slow, b.ground(0.0, SceneBuilder::kGestural), slow_spring * k);
    b.spring(fast, b.ground(), fast_spring * k);
    return b;
  }
};

/// The equations of hold and mean, from a state (X, X', x, x').
using State = Eigen::Vector4d;

State holdAndMean(const Pair& p, const State& from) {
  double x = from[2];
  double before = from[3];
  double mean = 0.0;
  for (int m = 0; m < p.ratio; ++m) {
    const double held_step = m == 0 ? from[0] - from[1] : 0.0;
    const double f =
        p.stiffness * (from[0] - x) + p.damping * (held_step - (x - before));  // pulls x up
    mean += f / p.ratio;
    const double next = 2.0 * x - before + (f - p.fast_spring * x) / p.fast_mass;
    before = x;
    x = next;
  }
  const double big_step2 = static_cast<double>(p.ratio * p.ratio);
  const double next =
      2.0 * from[0] - from[1] - big_step2 / p.slow_mass * (mean + p.slow_spring * from[0]);
  return {next, from[0], x, before};
}

template <class Step>
Eigen::MatrixXd matrixOf(const Pair& p, Step step) {
  Eigen::MatrixXd matrix(4, 4);
  for (int i = 0; i < 4; ++i) {
    matrix.col(i) = step(p, State::Unit(i));
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

/// K T^2 (1/M + 1/m) = 0.4, a tenth of the limit; the fast spring tunes the fast mass below half
/// the slow rate.
Pair tenthOfTheLimit(int ratio) {
  Pair p;
  p.ratio = ratio;
  const double step2 = static_cast<double>(ratio * ratio);
  p.stiffness = 0.4 / (step2 * (1.0 / p.slow_mass + 1.0 / p.fast_mass));
  p.slow_spring = 0.05 / step2;
  p.fast_spring = 0.07 / step2;
  return p;
}

TEST(MonodromyTest, HoldAndMeanTurnByTheAnglesOfTheirEquations) {
  for (const int ratio : {4, 14, 44}) {
    const Pair p = tenthOfTheLimit(ratio);
    const auto matrix = monodromy(p.scene().scene, {kRate, ratio});
    expectSameEigenvalues(matrix, matrixOf(p, holdAndMean));
    EXPECT_NEAR(spectralRadius(matrix), 1.0, 1e-12);
  }
}

TEST(MonodromyTest, DampedHoldAndMeanShrinkByTheRadiusOfTheirEquations) {
  for (const int ratio : {4, 14, 44}) {
    Pair p = tenthOfTheLimit(ratio);
    p.damping = 0.02 / ratio;
    const auto matrix = monodromy(p.scene().scene, {kRate, ratio});
    expectSameEigenvalues(matrix, matrixOf(p, holdAndMean));
    EXPECT_LT(spectralRadius(matrix), 1.0);
  }
}

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
  Pair p = tenthOfTheLimit(14);
  p.slow_spring = 0.0;
  p.fast_spring = 0.0;
  EXPECT_EQ(spectralRadius(monodromy(p.scene().scene, {kRate, 14})), 1.0);
}

TEST(MonodromyTest, SectionsSlowerThanATickAreSteppedToTheirEnd) {
  Pair p = tenthOfTheLimit(28);
  SceneBuilder b = p.scene();
  b.scene.sections[SceneBuilder::kGestural].gestural = false;
  b.scene.sections[SceneBuilder::kGestural].divisor = 28;
  expectSameEigenvalues(monodromy(b.scene, {kRate, 14}), matrixOf(p, holdAndMean));
}

TEST(MonodromyTest, TakesTheLinearPartOnly) {
  Pair p = tenthOfTheLimit(14);
  const auto linear = monodromy(p.scene().scene, {kRate, 14});
  SceneBuilder b = p.scene();
  b.scene.sections[0].gravity.x() = -9.81;
  b.scene.mats[0].position.x() = 0.3;
  b.scene.mats[1].push.edit().velocity.x() = 2.0;
  b.scene.lias[0].type = scene::LiaType::kCubic;
  b.scene.lias[0].law.edit().nonlinearity = {1e9};
  b.link(scene::LiaType::kContact, 0, 1, kRate * kRate);
  b.link(scene::LiaType::kSmoothBow, b.slice(0), 1, 0.0, 1.0);
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
  EXPECT_NE(c.findings.front().find("grows by a factor of exp("), std::string::npos);
}

TEST(MonodromyTest, ALittleLossMakesThatStringProven) {
  const SceneBuilder b = stringOnSlowMass(24, 2e-3);
  EXPECT_LE(spectralRadius(monodromy(b.scene, {kRate, 14})), 1.0 + 1e-9);
  EXPECT_EQ(certify(b.scene, {kRate, 14}).verdict, Verdict::kPassive);
}

TEST(MonodromyTest, BeyondThreeHundredMassesNothingIsProven) {
  const Certificate c = certify(stringOnSlowMass(320, 2e-3).scene, {kRate, 14});
  EXPECT_EQ(c.verdict, Verdict::kUnproven);
  ASSERT_FALSE(c.findings.empty());
  EXPECT_NE(c.findings.front().find("321 masses"), std::string::npos);
  EXPECT_NE(c.findings.front().find("which proves nothing"), std::string::npos);
}

}  // namespace
}  // namespace ergotic::physics
