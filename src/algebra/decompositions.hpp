// SPDX-License-Identifier: BSD-3-Clause
/// Decompositions of dense matrices, each compiled once: Eigen's take seconds in every source that
/// uses them. None of them is for the tick. Thread: any
#pragma once

#include <optional>

#include <Eigen/Core>

namespace ergotic::algebra {

/// Eigenvalues of a symmetric matrix [n][n], of which the lower triangle is read, ascending.
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& matrix);

struct SymmetricModes {
  Eigen::VectorXd values;   ///< [n], ascending
  Eigen::MatrixXd vectors;  ///< [n][n], a column each, orthonormal
  bool converged = false;
};
/// Eigenvalues and eigenvectors of a symmetric matrix [n][n], of which the lower triangle is read.
SymmetricModes symmetricModes(const Eigen::MatrixXd& matrix);

struct GeneralModes {
  Eigen::VectorXcd values;   ///< [n], in no order, conjugates side by side
  Eigen::MatrixXcd vectors;  ///< [n][n], a column each
  bool converged = false;
};
GeneralModes generalModes(const Eigen::MatrixXd& matrix);
/// Eigenvalues of a matrix [n][n]; nullopt if they do not converge.
std::optional<Eigen::VectorXcd> generalEigenvalues(const Eigen::MatrixXd& matrix);

struct Kernel {
  Eigen::Index rank = 0;
  Eigen::MatrixXd basis;  ///< [n][n - rank]; one column of 0 if the rank is n
};
/// Kernel of a matrix [n][n]. \param threshold  of pivots, over the largest of them
Kernel kernelOf(const Eigen::MatrixXd& matrix, double threshold);

/// An orthonormal basis [n][n - k] of the complement of k columns of length n.
Eigen::MatrixXd orthogonalComplement(const Eigen::MatrixXd& columns);

Eigen::MatrixXd inverse(const Eigen::MatrixXd& matrix);
Eigen::MatrixXcd inverse(const Eigen::MatrixXcd& matrix);
/// X of `matrix` X = `right`.
Eigen::MatrixXd solve(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

}  // namespace ergotic::algebra
