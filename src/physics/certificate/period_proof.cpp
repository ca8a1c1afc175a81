// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/period_proof.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace ergotic::physics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kFixed = 1e-12;    // of the largest pivot: what a period leaves as it is
constexpr double kFading = 0.99;    // per period
constexpr double kMostOff = 5e-10;  // of what G s becomes
constexpr int kDoublings = 40;
constexpr double kAlike = 1e-6;     // of places of bodies
constexpr double kStaying = 1e-10;  // of a body, whatever rounds
constexpr double kNear = 0.1;       // of eigenvalues that rounding might bring together
constexpr double kSlow = 1e-8;      // per period, of growth that is none

/// Rows that a period makes B times themselves.
struct Form {
  MatrixXd rows;
  MatrixXd turn;
};

/// An orthonormal basis of what is at right angles to some columns.
MatrixXd beside(const MatrixXd& columns) {
  const Index size = columns.rows();
  if (columns.cols() == 0) {
    return MatrixXd::Identity(size, size);
  }
  const Eigen::HouseholderQR<MatrixXd> solver(columns);
  return (solver.householderQ() * MatrixXd::Identity(size, size)).rightCols(size - columns.cols());
}

/// True if what stays are the places of as many bodies, which nothing holds: the modules of each
/// moved alike, all at rest. A mode that comes back to where it was within a period stays, too.
bool areBodies(const MatrixXd& stays) {
  const Index modules = stays.rows() / 2;
  std::vector<Eigen::RowVectorXd> places;
  for (Index m = 0; m < modules; ++m) {
    const Eigen::RowVectorXd place = stays.row(m);
    const auto isHere = [&](const auto& known) { return (known - place).norm() < kAlike; };
    if (place.norm() >= kAlike && std::none_of(places.begin(), places.end(), isHere)) {
      places.push_back(place);
    }
  }
  return stays.bottomRows(modules).norm() < kAlike &&
         static_cast<Index>(places.size()) <= stays.cols();
}

/// At right angles to what a period leaves as it is; none if that is not only where bodies lie,
/// however it is rounded.
std::optional<MatrixXd> besideWhatStays(const MatrixXd& matrix,
                                        const std::vector<MatrixXd>& rounded) {
  const MatrixXd unit = MatrixXd::Identity(matrix.rows(), matrix.cols());
  Eigen::FullPivLU<MatrixXd> change(matrix - unit);
  change.setThreshold(kFixed);
  if (change.rank() == matrix.rows()) {
    return unit;
  }
  const MatrixXd stays = change.kernel();
  const bool stay = std::all_of(rounded.begin(), rounded.end(), [&](const MatrixXd& other) {
    return (other * stays - stays).norm() <= kStaying * stays.norm();
  });
  return stay && areBodies(stays) ? std::optional<MatrixXd>(beside(stays)) : std::nullopt;
}

/// Real and imaginary parts of the eigenvectors of what hardly fades, as columns, and what becomes
/// of their transpose.
Form lastingOf(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix);
  Form form{MatrixXd(matrix.rows(), matrix.rows()), MatrixXd::Zero(matrix.rows(), matrix.rows())};
  Index count = 0;
  for (Index i = 0; i < matrix.rows(); ++i) {
    const std::complex<double> value = solver.eigenvalues()[i];
    if (!(std::abs(value) > kFading) || value.imag() < 0.0) {
      continue;
    }
    const Eigen::VectorXcd vector = solver.eigenvectors().col(i).normalized();
    form.rows.col(count) = vector.real();
    form.turn(count, count) = value.real();
    if (value.imag() > 0.0) {
      form.rows.col(count + 1) = vector.imag();
      form.turn(count + 1, count + 1) = value.real();
      form.turn(count, count + 1) = -value.imag();
      form.turn(count + 1, count) = value.imag();
    }
    count += value.imag() > 0.0 ? 2 : 1;
  }
  return {form.rows.leftCols(count), form.turn.topLeftCorner(count, count)};
}

/// P = sum over k of (B^k)' B^k, so that P - B' P B = I.
MatrixXd lyapunov(MatrixXd power) {
  MatrixXd sum = MatrixXd::Identity(power.rows(), power.cols());
  for (int k = 0; k < kDoublings && power.squaredNorm() > 0.0; ++k) {
    sum += power.transpose() * sum * power;
    power = power * power;
  }
  return sum;
}

Form fadingOf(const MatrixXd& matrix, const MatrixXd& lasting) {
  const MatrixXd others = beside(lasting);
  if (others.cols() == 0) {
    return {};
  }
  const MatrixXd turn = others.transpose() * matrix * others;
  const MatrixXd root = lyapunov(turn).llt().matrixU();
  const MatrixXd back =
      root.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(root.rows(), root.cols()));
  return {root * others.transpose(), root * turn * back};
}

Form joined(const Form& a, const Form& b, Index columns) {
  const Index rows = a.rows.rows() + b.rows.rows();
  Form both{MatrixXd(rows, columns), MatrixXd::Zero(rows, rows)};
  both.rows.topRows(a.rows.rows()) = a.rows;
  both.rows.bottomRows(b.rows.rows()) = b.rows;
  both.turn.topLeftCorner(a.turn.rows(), a.turn.cols()) = a.turn;
  both.turn.bottomRightCorner(b.turn.rows(), b.turn.cols()) = b.turn;
  return both;
}

/// How far the form is from becoming B times itself.
double errorOf(const Form& form, const MatrixXd& matrix) {
  const Eigen::PartialPivLU<MatrixXd> solver(form.rows.transpose());
  const MatrixXd becomes = solver.solve((form.rows * matrix).transpose()).transpose();
  return (becomes - form.turn).norm();
}

/// By how much two eigenvalues grow, at most, while a perturbation of them grows from -1 to 1:
/// those of [[x, 0], [0, y]] + t [[a, b], [c, d]].
double growthOfPair(std::complex<double> x,
                    std::complex<double> y,
                    const Eigen::Matrix2cd& perturbation) {
  // Of logarithms: real parts grow, imaginary ones turn.
  const std::complex<double> apart = 0.5 * std::log(x / y);
  const std::complex<double> change = 0.5 * (perturbation(0, 0) / x - perturbation(1, 1) / y);
  const std::complex<double> joint = perturbation(0, 1) * perturbation(1, 0) / (x * y);
  const double nearest =
      change == 0.0 ? 0.0 : -(std::conj(change) * apart).real() / std::norm(change);
  double growth = 0.0;
  for (const double t : {0.0, -1.0, 1.0, std::clamp(nearest, -1.0, 1.0)}) {
    const std::complex<double> off = apart + t * change;
    growth = std::max(growth, std::sqrt(off * off + t * t * joint).real());
  }
  return growth;
}

/// True if rounding may make two lasting modes, or one and its conjugate, feed one another.
bool mayGrow(const MatrixXd& matrix, const MatrixXd& rounding) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix);
  const Eigen::VectorXcd values = solver.eigenvalues();
  const Eigen::MatrixXcd right = solver.eigenvectors();
  const Eigen::MatrixXcd shift = right.inverse() * rounding * right;
  if (!shift.allFinite()) {
    return true;
  }
  for (Index i = 0; i < values.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      const double lasting = std::min(std::abs(values[i]), std::abs(values[j]));
      if (!(lasting > kFading) || std::abs(values[i] - values[j]) > kNear) {
        continue;
      }
      Eigen::Matrix2cd pair;
      pair << shift(i, i), shift(i, j), shift(j, i), shift(j, j);
      if (growthOfPair(values[i], values[j], pair) > 1.0 - lasting + kSlow) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

std::optional<PeriodProof> proofOf(const Period& period, const std::vector<MatrixXd>& rounded) {
  const std::optional<MatrixXd> beside_bodies = besideWhatStays(period.matrix, rounded);
  if (!beside_bodies) {
    return std::nullopt;
  }
  const MatrixXd& kept = *beside_bodies;
  const MatrixXd matrix = kept.transpose() * period.matrix * kept;
  Form lasting = lastingOf(matrix.transpose());
  lasting.rows.transposeInPlace();
  const Form form = joined(lasting, fadingOf(matrix, lastingOf(matrix).rows), matrix.cols());
  if (form.rows.rows() != form.rows.cols() || !(errorOf(form, matrix) <= kMostOff)) {
    return std::nullopt;
  }
  for (const MatrixXd& other : rounded) {
    if (mayGrow(matrix, kept.transpose() * (other - period.matrix) * kept)) {
      return std::nullopt;
    }
  }
  const Index modules = period.units.size();
  PeriodProof proof{{}, 0, period.modules, form.rows * kept.transpose(), form.turn};
  proof.form.rightCols(modules) *= period.units.cwiseInverse().asDiagonal();
  return proof;
}

}  // namespace ergotic::physics
