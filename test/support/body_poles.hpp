// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "ergotic/scene/scene.hpp"

namespace ergotic::test {

/// What the equations of a step say of a settled, linear, scalar scene of one section, worked out
/// without the certificate and the engine.
struct BodyPoles {
  /// x[n+1] = (2 - kappa - zeta) x[n] - (1 - zeta) x[n-1], of M^1/2 x.
  Eigen::MatrixXd kappa;
  Eigen::MatrixXd zeta;
  std::vector<int> mats;  ///< the masses and cells: indices in Scene::mats

  BodyPoles(const scene::Scene& scene, double rate_hz);
  /// One of each pair, by frequency; what does not swing is left out.
  std::vector<std::complex<double>> poles() const;
  /// h^2 w^2 of the springs, by size.
  std::vector<double> eigenvalues() const;
  /// Displacements in mode `index` without losses, the largest of them 1.
  Eigen::VectorXd shape(const scene::Scene& scene, int index) const;

 private:
  double rate_hz_;
};

double frequencyOf(std::complex<double> pole, double rate_hz);
double t60Of(std::complex<double> pole, double rate_hz);

}  // namespace ergotic::test
