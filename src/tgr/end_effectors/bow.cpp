// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Core>

#include "ergotic/rt/realtime.hpp"
#include "tgr/end_effectors/makers.hpp"

namespace ergotic::tgr {
namespace {

/// Bow: two levers at a right angle, rotated: x = R(angle) lever (q0, q1).
class Bow final : public Kinematics {
 public:
  Bow(double lever, double angle)
      : Kinematics(2, 2), matrix_(lever * Eigen::Rotation2Dd(angle).toRotationMatrix()) {}

  ERGOTIC_REALTIME bool forward(const double* q,
                                double* x,
                                double* jacobian) const noexcept override {
    if (!std::isfinite(q[0]) || !std::isfinite(q[1])) {
      return false;
    }
    Eigen::Map<Eigen::Vector2d> at(x);
    at.noalias() = matrix_ * Eigen::Vector2d(q[0], q[1]);
    Eigen::Map<Eigen::Matrix<double, 2, 2, Eigen::RowMajor>> rows(jacobian);
    rows = matrix_;
    return true;
  }

  /// Pose of the bow. It moves along x of its frame and is pressed along z.
  ERGOTIC_REALTIME Eigen::Isometry3d pose(const double* q) const noexcept override {
    const Eigen::Vector2d at = matrix_ * Eigen::Vector2d(q[0], q[1]);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(at.x(), 0.0, at.y());
    return pose;
  }

 private:
  Eigen::Matrix2d matrix_;
};

}  // namespace

std::unique_ptr<Kinematics> makeBow(const EndEffectorConfig& config) {
  return std::make_unique<Bow>(config.lever, config.angle);
}

}  // namespace ergotic::tgr
