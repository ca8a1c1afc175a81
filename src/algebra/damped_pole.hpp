// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <optional>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace ergotic::algebra {

/// A pole of w^2 x + w B x + P x = 0, and its shape.
struct DampedPole {
  std::complex<double> w;
  Eigen::VectorXcd shape;  ///< [n], x'x = 1 (without conjugation) where that is not 0
};

/// Scales a shape as `DampedPole` has it.
void normalize(Eigen::VectorXcd& shape);

/// One step of inverse iteration towards the pole that is nearest to a guess; for symmetric
/// matrices the error is cubed. nullopt if the equations at the guess cannot be solved. Thread: any
/// \param both  B [n][n], \param pull  P [n][n]
std::optional<DampedPole> refinedPole(const Eigen::SparseMatrix<double>& both,
                                      const Eigen::SparseMatrix<double>& pull,
                                      const DampedPole& guess);

}  // namespace ergotic::algebra
