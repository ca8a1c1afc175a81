// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/lyapunov_form.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "support/test.hpp"

namespace ergotic::physics {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;

/// Of so many modules as the matrix has, in units of their own.
Period periodOf(const Eigen::MatrixXd& matrix) {
  const Eigen::Index modules = matrix.rows() / 2;
  return {matrix, std::vector<int>(static_cast<std::size_t>(modules), 0),
          Eigen::VectorXd::Ones(modules), Eigen::MatrixXd::Identity(modules, modules),
          Eigen::VectorXd::Ones(modules)};
}

Matrix2d turn(double angle) {
  Matrix2d matrix;
  matrix << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return matrix;
}

/// Two modules, each with its position and what it is about to move by.
Matrix4d ofTwo(const Matrix2d& a, const Matrix2d& b) {
  Matrix4d matrix = Matrix4d::Zero();
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      matrix(2 * row, 2 * column) = a(row, column);
      matrix(2 * row + 1, 2 * column + 1) = b(row, column);
    }
  }
  return matrix;
}

/// What the second of two modules makes of the first, and the other way round.
Matrix4d joinedBy(const Matrix2d& first, const Matrix2d& second, Matrix4d matrix) {
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      matrix(2 * row, 2 * column + 1) = first(row, column);
      matrix(2 * row + 1, 2 * column) = second(row, column);
    }
  }
  return matrix;
}

TEST(LyapunovFormTest, FormIsKeptByThePeriod) {
  const Matrix4d matrix = ofTwo(turn(1.0), 0.5 * turn(2.0));
  const std::optional<LyapunovForm> form = lyapunovFormOf(periodOf(matrix), {});
  ASSERT_TRUE(form);
  EXPECT_LT((form->form * matrix - form->turn * form->form).norm(), 1e-12);
  EXPECT_LE(form->turn.operatorNorm(), 1.0 + 1e-12);
}

/// What stays is where bodies are, however it is rounded. A mode that comes back after a period
/// stays, too, and the least that is rounded may let it grow.
TEST(LyapunovFormTest, OnlyBodiesMayStay) {
  Matrix2d drift;
  drift << 1.0, 1.0, 0.0, 1.0;
  Matrix2d held = drift;
  held(1, 0) = 1e-7;
  const Matrix4d body = ofTwo(turn(1.0), drift);
  EXPECT_TRUE(lyapunovFormOf(periodOf(body), {body}));
  EXPECT_FALSE(lyapunovFormOf(periodOf(body), {ofTwo(turn(1.0), held)}));
  EXPECT_FALSE(lyapunovFormOf(periodOf(ofTwo(turn(1.0), Matrix2d::Identity())), {}));
}

/// As far as rounding joins two modes they grow, if each drives the other: not where they are apart
/// by more than twice that, and not where one brakes what the other drives.
TEST(LyapunovFormTest, RoundingMayJoinModes) {
  const auto isProven = [](double apart, double joined, double back) {
    const Matrix4d matrix = ofTwo(turn(1.0), turn(1.0 + apart));
    return lyapunovFormOf(periodOf(matrix),
                          {joinedBy(joined * turn(1.0), back * turn(1.0), matrix)})
        .has_value();
  };
  EXPECT_TRUE(isProven(1e-5, 4e-6, 4e-6));
  EXPECT_FALSE(isProven(1e-5, 6e-6, 6e-6));
  EXPECT_TRUE(isProven(1e-5, 6e-6, -6e-6));
}

/// One of two loses more than the other: what it feeds need not make up for both losses to grow.
TEST(LyapunovFormTest, RoundingMayFeedTheModeThatLosesLess) {
  const auto isProven = [](double joined) {
    const Matrix4d matrix = ofTwo(0.995 * turn(1.0), turn(1.0));
    const Matrix4d rounded = joinedBy(joined * turn(1.0), joined * turn(1.0), matrix);
    EXPECT_GT(rounded.eigenvalues().cwiseAbs().maxCoeff(), 1.0 + joined * joined);
    return lyapunovFormOf(periodOf(matrix), {rounded}).has_value();
  };
  EXPECT_FALSE(isProven(3e-3));
  EXPECT_TRUE(isProven(1e-6));
}

TEST(LyapunovFormTest, RoundingMayTakeAwayWhatAModeLoses) {
  const auto isProven = [](double loss) {
    const Matrix4d matrix = ofTwo((1.0 - loss) * turn(1.0), 0.9 * turn(2.0));
    return lyapunovFormOf(periodOf(matrix),
                          {ofTwo((1.0 - loss + 1e-6) * turn(1.0), 0.9 * turn(2.0))})
        .has_value();
  };
  EXPECT_FALSE(isProven(9e-7));
  EXPECT_TRUE(isProven(1.1e-6));
}

/// Two modes that have nearly met: what begins small becomes large before it comes back.
TEST(LyapunovFormTest, ModesThatNearlyMeetHaveNone) {
  const auto isProven = [](double left) {
    const double apart = 0.01;
    const Matrix2d joined = (1.0 - left) * std::sin(apart / 2.0) * turn(1.0 + apart / 2.0);
    const Matrix4d matrix = joinedBy(joined, joined, ofTwo(turn(1.0), turn(1.0 + apart)));
    return lyapunovFormOf(periodOf(matrix), {}).has_value();
  };
  EXPECT_FALSE(isProven(1e-6));
  EXPECT_FALSE(isProven(1e-3));
  EXPECT_TRUE(isProven(1e-2));
}

}  // namespace
}  // namespace ergotic::physics
