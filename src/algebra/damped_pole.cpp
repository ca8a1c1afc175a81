// SPDX-License-Identifier: BSD-3-Clause
#include "algebra/damped_pole.hpp"

#include <cmath>

#include <Eigen/SparseLU>

namespace ergotic::algebra {
namespace {

using Complex = std::complex<double>;
using ComplexMatrix = Eigen::SparseMatrix<Complex>;

/// Product of two vectors without conjugation.
Complex product(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  return (a.transpose() * b)(0, 0);
}

/// The root of a w^2 + b w + c = 0 that is nearer to a guess.
Complex nearerRoot(Complex a, Complex b, Complex c, Complex guess) {
  const Complex root = std::sqrt(b * b - 4.0 * a * c);
  const Complex sum = std::abs(b + root) > std::abs(b - root) ? b + root : b - root;
  const Complex one = -sum / (2.0 * a);
  const Complex other = sum == 0.0 ? one : -2.0 * c / sum;
  return std::abs(one - guess) < std::abs(other - guess) ? one : other;
}

}  // namespace

void normalize(Eigen::VectorXcd& shape) {
  const Complex length = std::sqrt(product(shape, shape));
  shape /= std::abs(length) > 1e-9 * shape.norm() ? length : Complex(shape.norm());
}

std::optional<DampedPole> refinedPole(const Eigen::SparseMatrix<double>& both,
                                      const Eigen::SparseMatrix<double>& pull,
                                      const DampedPole& guess) {
  const Complex w = guess.w;
  ComplexMatrix unit(pull.rows(), pull.cols());
  unit.setIdentity();
  ComplexMatrix matrix = w * both.cast<Complex>() + pull.cast<Complex>();
  matrix += w * w * unit;
  matrix.makeCompressed();
  Eigen::SparseLU<ComplexMatrix> solver(matrix);
  if (solver.info() != Eigen::Success) {
    return std::nullopt;
  }
  const Eigen::VectorXcd slope = 2.0 * w * guess.shape + both * guess.shape;
  DampedPole next{w, solver.solve(slope)};
  if (!next.shape.allFinite()) {
    return std::nullopt;
  }
  next.shape /= next.shape.norm();
  normalize(next.shape);
  const Eigen::VectorXcd of_both = both * next.shape;
  const Eigen::VectorXcd of_pull = pull * next.shape;
  next.w = nearerRoot(product(next.shape, next.shape), product(next.shape, of_both),
                      product(next.shape, of_pull), w);
  return next;
}

}  // namespace ergotic::algebra
