// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "advice/mode_solver.hpp"

namespace ergotic::physics {

/// A pole of the equations of a step, 1 + w, and its shape in coordinates M^1/2 x with x'x = 1.
struct DampedMode {
  std::complex<double> w;
  Eigen::VectorXcd shape;
  double error = 0.0;  ///< relative, of w, to first order; 0: rounding
};

/// The modes of a part with its losses: w^2 + w (L + P) + P = 0. Where the losses have the modes
/// of the springs they are the first-order quotients, exactly; else the problem is solved among the
/// modes that are known, and each pole is refined on the whole by inverse iteration.
/// \param count  of the pairs behind the rigid ones
std::vector<DampedMode> dampedModesOf(const ModePart& part, const EigenPairs& pairs, int count);

/// The slower root of w^2 + w (zeta + kappa) + kappa = 0, that with the positive angle if they
/// swing.
std::complex<double> poleOf(double kappa, double zeta);

}  // namespace ergotic::physics
