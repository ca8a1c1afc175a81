// SPDX-License-Identifier: BSD-3-Clause
#include "algebra/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace ergotic::algebra {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;

Eigen::VectorXd symmetricEigenvalues(const MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

SymmetricModes symmetricModes(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors(), solver.info() == Eigen::Success};
}

GeneralModes generalModes(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) {
    return {};
  }
  return {solver.eigenvalues(), solver.eigenvectors(), true};
}

std::optional<Eigen::VectorXcd> generalEigenvalues(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success) {
    return std::nullopt;
  }
  return solver.eigenvalues();
}

Kernel kernelOf(const MatrixXd& matrix, double threshold) {
  Eigen::FullPivLU<MatrixXd> solver(matrix);
  solver.setThreshold(threshold);
  return {solver.rank(), solver.kernel()};
}

MatrixXd orthogonalComplement(const MatrixXd& columns) {
  const Eigen::Index size = columns.rows();
  if (columns.cols() == 0) {
    return MatrixXd::Identity(size, size);
  }
  const Eigen::HouseholderQR<MatrixXd> solver(columns);
  return (solver.householderQ() * MatrixXd::Identity(size, size)).rightCols(size - columns.cols());
}

MatrixXd inverse(const MatrixXd& matrix) {
  return matrix.inverse();
}

MatrixXcd inverse(const MatrixXcd& matrix) {
  return matrix.inverse();
}

MatrixXd solve(const MatrixXd& matrix, const MatrixXd& right) {
  return matrix.partialPivLu().solve(right);
}

}  // namespace ergotic::algebra
