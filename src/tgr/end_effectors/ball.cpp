// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/realtime.hpp"
#include "scene/limits.hpp"
#include "tgr/end_effectors/linkage.hpp"
#include "tgr/end_effectors/makers.hpp"

namespace ergotic::tgr {
namespace {

constexpr int kBallRods = 3;
constexpr double kMaxSlender = 20.0;  // rod over its horizontal part, at rest

/// Unit vectors from the axis to the slices: 90, 210, 330 degrees.
Eigen::Vector2d directionOf(int rod) {
  const double angle = kPi * (0.5 + 2.0 / 3.0 * rod);
  return {std::cos(angle), std::sin(angle)};
}

/// A linear delta. Each slice stands at radius base_radius and moves along z; a rod (in truth a
/// parallelogram, so that the platform cannot turn) joins it to the platform at radius
/// platform_radius. So the centre of the platform lies on three spheres of radius `rod` about
/// (d e_i, q_i), d = base_radius - platform_radius, on the upper of the two points they share.
class Ball final : public Kinematics {
 public:
  Ball(double rod, double offset)
      : Kinematics(kBallRods, 3),
        rod_(rod),
        offset_(offset),
        rest_(restHeight(rod, std::abs(offset))) {
    for (int i = 0; i < kBallRods; ++i) {
      directions_.col(i) = directionOf(i);
    }
    const std::array<double, kBallRods> rest{};
    most_gain_ = kMaxGain * jacobianAt(rest.data(), {0.0, 0.0, rest_}).norm();
  }

  ERGOTIC_REALTIME bool forward(const double* q,
                                double* x,
                                double* jacobian) const noexcept override {
    const Eigen::Vector3d platform = platformAt(q);
    const Eigen::Matrix3d dx_dq = jacobianAt(q, platform);
    const Eigen::Map<const Eigen::Vector3d> slices(q);
    const double lowest = platform.z() - slices.maxCoeff();
    if (!(lowest >= kFlattestRod * rod_ && dx_dq.norm() <= most_gain_)) {  // NaN, too
      return false;
    }
    Eigen::Map<Eigen::Vector3d> at(x);
    at = platform;
    at.z() -= rest_;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rows(jacobian);
    rows = dx_dq;
    return true;
  }

  ERGOTIC_REALTIME Eigen::Isometry3d pose(const double* q) const noexcept override {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = platformAt(q) - rest_ * Eigen::Vector3d::UnitZ();
    return pose;
  }

 private:
  /// Position of the platform: differences of the spheres' equations give x and y as a + b z, their
  /// mean then z. Not a number where the spheres do not meet.
  Eigen::Vector3d platformAt(const double* q) const noexcept {
    const Eigen::Map<const Eigen::Vector3d> slices(q);
    const double mean = slices.mean();
    const Eigen::Vector3d s = slices.array() - mean;
    const double mean_square = s.squaredNorm() / kBallRods;
    const Eigen::Vector2d a = directions_ * s.cwiseAbs2() / (kBallRods * offset_);
    const Eigen::Vector2d b = directions_ * s * (-2.0 / (kBallRods * offset_));
    const double curvature = 1.0 + b.squaredNorm();
    const double slope = a.dot(b);
    const double constant = a.squaredNorm() + offset_ * offset_ + mean_square - rod_ * rod_;
    const double discriminant = slope * slope - curvature * constant;
    const double z = (std::sqrt(discriminant) - slope) / curvature;
    return {a.x() + b.x() * z, a.y() + b.y() * z, z + mean};
  }

  /// The rods keep their lengths: l_i (dp - e_z dq_i) = 0.
  Eigen::Matrix3d jacobianAt(const double* q, const Eigen::Vector3d& platform) const noexcept {
    Eigen::Matrix3d rods;
    for (int i = 0; i < kBallRods; ++i) {
      rods.row(i) << (platform.head<2>() - offset_ * directions_.col(i)).transpose(),
          platform.z() - q[i];
    }
    return rods.inverse() * rods.col(2).asDiagonal();
  }

  double rod_;
  double offset_;  ///< d
  double rest_;    ///< height of the platform over slices at rest
  double most_gain_ = 0.0;
  Eigen::Matrix<double, 2, kBallRods> directions_;
};

}  // namespace

std::unique_ptr<Kinematics> makeBall(const EndEffectorConfig& config) {
  const double offset = config.base_radius - config.platform_radius;
  if (std::abs(offset) * kMaxSlender < config.rod) {
    throw Exception("base_radius - platform_radius = " + scene::numberText(offset) +
                    " m holds no platform sideways, allowed: beyond +-" +
                    scene::numberText(config.rod / kMaxSlender) + " m");
  }
  return std::make_unique<Ball>(config.rod, offset);
}

}  // namespace ergotic::tgr
