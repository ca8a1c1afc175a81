// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <Eigen/Dense>

#include "ergotic/tgr/end_effector.hpp"

namespace ergotic::tgr {
namespace {

constexpr int kSlices = Kinematics::kMaxSlicesOfOne;
constexpr int kCoordinates = Kinematics::kMaxCoordinates;
constexpr int kMaxSteps = 60;
constexpr double kMinDamping = 1e-12;
constexpr double kMaxDamping = 1e9;

using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kCoordinates, 1>;
using Matrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kCoordinates, kSlices>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kSlices, kSlices>;

/// Coordinates of an end-effector with its slices at q, and their error to the wanted ones.
struct Place {
  Vector q;
  Vector missing;
  Matrix jacobian;
  bool is_within = false;
};

Place placeAt(const Kinematics& kinematics, const Vector& q, const double* wanted) {
  Place place{q, Vector(kinematics.coordinates()),
              Matrix(kinematics.coordinates(), kinematics.slices())};
  place.is_within = kinematics.forward(q.data(), place.missing.data(), place.jacobian.data());
  place.missing = Eigen::Map<const Vector>(wanted, kinematics.coordinates()) - place.missing;
  return place;
}

}  // namespace

double bringTo(const Kinematics& kinematics, const double* x, double most, double* q) noexcept {
  Place now = placeAt(kinematics, Eigen::Map<const Vector>(q, kinematics.slices()), x);
  double damping = 1e-3;
  for (int i = 0; i < kMaxSteps && now.is_within && damping < kMaxDamping; ++i) {
    Square normal = now.jacobian.transpose() * now.jacobian;
    normal.diagonal() *= 1.0 + damping;
    normal.diagonal().array() += kMinDamping;
    const Vector step = normal.ldlt().solve(now.jacobian.transpose() * now.missing);
    const Place next = placeAt(kinematics, (now.q + step).cwiseMax(-most).cwiseMin(most), x);
    if (next.is_within && next.missing.squaredNorm() < now.missing.squaredNorm()) {
      now = next;
      damping *= 0.1;
    } else {
      damping *= 10.0;
    }
  }
  std::copy_n(now.q.data(), kinematics.slices(), q);
  return now.missing.norm();
}

}  // namespace ergotic::tgr
