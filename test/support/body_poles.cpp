// SPDX-License-Identifier: BSD-3-Clause
#include "support/body_poles.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "at.hpp"

namespace ergotic::test {

BodyPoles::BodyPoles(const scene::Scene& scene, double rate_hz) : rate_hz_(rate_hz) {
  const double step = 1.0 / rate_hz;
  std::vector<int> index(scene.mats.size(), -1);
  for (std::size_t m = 0; m < scene.mats.size(); ++m) {
    const scene::MatType type = scene.mats[m].type;
    if (type == scene::MatType::kMass || type == scene::MatType::kCell) {
      index[m] = static_cast<int>(mats.size());
      mats.push_back(static_cast<int>(m));
    }
  }
  const auto count = static_cast<Eigen::Index>(mats.size());
  kappa = Eigen::MatrixXd::Zero(count, count);
  zeta = Eigen::MatrixXd::Zero(count, count);
  for (const scene::Lia& lia : scene.lias) {
    for (const auto& [row_mat, column_mat, sign] :
         {std::tuple{lia.a, lia.a, 1.0}, std::tuple{lia.b, lia.b, 1.0},
          std::tuple{lia.a, lia.b, -1.0}, std::tuple{lia.b, lia.a, -1.0}}) {
      const int row = index[at(row_mat)];
      const int column = index[at(column_mat)];
      if (row >= 0 && column >= 0) {
        const double root = std::sqrt(scene.valueOf(scene.mats[at(row_mat)].mass) *
                                      scene.valueOf(scene.mats[at(column_mat)].mass));
        kappa(row, column) += sign * scene.valueOf(lia.stiffness) * step * step / root;
        zeta(row, column) += sign * scene.valueOf(lia.damping) * step / root;
      }
    }
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const scene::Mat& mat = scene.mats[at(mats[static_cast<std::size_t>(i)])];
    const double loss = scene.valueOf(mat.damping) / scene.valueOf(mat.mass);
    zeta(i, i) += mat.type == scene::MatType::kCell ? -std::expm1(-loss * step) : 0.0;
  }
}

std::vector<std::complex<double>> BodyPoles::poles() const {
  const Eigen::Index count = kappa.rows();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(count, count);
  Eigen::MatrixXd step(2 * count, 2 * count);
  step << 2.0 * one - kappa - zeta, zeta - one, one, Eigen::MatrixXd::Zero(count, count);
  std::vector<std::complex<double>> swinging;
  for (const std::complex<double>& pole : step.eigenvalues()) {
    if (pole.imag() > 1e-6) {
      swinging.push_back(pole);
    }
  }
  std::sort(swinging.begin(), swinging.end(),
            [](const auto& a, const auto& b) { return std::arg(a) < std::arg(b); });
  return swinging;
}

std::vector<double> BodyPoles::eigenvalues() const {
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(kappa, Eigen::EigenvaluesOnly).eigenvalues();
  return {values.begin(), values.end()};
}

Eigen::VectorXd BodyPoles::shape(const scene::Scene& scene, int index) const {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(kappa);
  Eigen::VectorXd shape = solver.eigenvectors().col(index);
  for (Eigen::Index i = 0; i < shape.size(); ++i) {
    shape(i) /= std::sqrt(scene.valueOf(scene.mats[at(mats[static_cast<std::size_t>(i)])].mass));
  }
  return shape / shape.cwiseAbs().maxCoeff();
}

double frequencyOf(std::complex<double> pole, double rate_hz) {
  return std::arg(pole) / (2.0 * M_PI) * rate_hz;
}

double t60Of(std::complex<double> pole, double rate_hz) {
  return -std::log(1000.0) / (std::log(std::abs(pole)) * rate_hz);
}

}  // namespace ergotic::test
