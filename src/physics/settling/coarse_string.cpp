// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/coarse_string.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "at.hpp"
#include "constants.hpp"

namespace ergotic::physics {
namespace {
constexpr int kSprings = 3;

/// Eigenvalue that the spring to the k-th neighbour adds to mode j of N masses.
double shareOf(int spring, int mode, int masses) {
  return scene::stringEigenvalue(masses, spring * mode);
}

/// Least squares of `rows` k = 1, the first row exactly.
Eigen::Vector3d solve(const Eigen::MatrixXd& rows) {
  const Eigen::Vector3d first = rows.row(0);
  const Eigen::Vector3d exact = first / first.squaredNorm();
  const Eigen::Matrix3d turned = first.householderQr().householderQ();
  const Eigen::MatrixXd free = turned.rightCols(kSprings - 1);  // what the first row does not feel
  const Eigen::VectorXd rest = Eigen::VectorXd::Ones(rows.rows()) - rows * exact;
  return exact + free * (rows * free).colPivHouseholderQr().solve(rest);
}

}  // namespace

int fittedPartials(int masses) {
  return std::max(kSprings, masses / 2);
}

double CoarseFit::worstCents(int partials) const {
  double worst = 0.0;
  for (int j = 0; j < partials; ++j) {
    worst = std::max(worst, std::abs(cents[at(j)]));
  }
  return worst;
}

double coarseEigenvalue(const CoarseFit& fit, int masses, int mode) {
  double lambda = 0.0;
  for (int k = 0; k < kSprings; ++k) {
    lambda += fit.kappa[at(k)] * shareOf(k + 1, mode, masses);
  }
  return lambda;
}

int wildMode(const CoarseFit& fit, int masses) {
  for (int mode = 1; mode <= masses; ++mode) {
    const double lambda = coarseEigenvalue(fit, masses, mode);
    if (!(lambda > 0.0 && lambda < 4.0)) {
      return mode;
    }
  }
  return 0;
}

CoarseFit fitCoarseString(int masses,
                          double frequency,
                          int partials,
                          const scene::StringLoss& loss) {
  Eigen::MatrixXd shares(partials, kSprings);
  for (int j = 1; j <= partials; ++j) {
    const double wanted = scene::modeKappa(2.0 * kPi * frequency * j, loss.ofMode(masses, j));
    for (int k = 1; k <= kSprings; ++k) {
      shares(j - 1, k - 1) = shareOf(k, j, masses) / wanted;
    }
  }
  const Eigen::Vector3d kappa = solve(shares);
  CoarseFit fit;
  fit.kappa = {kappa[0], kappa[1], kappa[2]};
  for (int j = 1; j <= partials; ++j) {
    const double angle = scene::modeAngle(coarseEigenvalue(fit, masses, j), loss.ofMode(masses, j));
    fit.cents.push_back(1200.0 * std::log2(angle / (2.0 * kPi * frequency * j)));
  }
  return fit;
}

}  // namespace ergotic::physics
