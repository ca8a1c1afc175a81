// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "ergotic/rt/realtime.hpp"
#include "tgr/end_effectors/makers.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kCosineOfMostTilt = 0.5;  // 60 degrees: the tip gains four times less than at rest
constexpr double kShortest = 0.25;         // of its length: how far a stick slides in
constexpr double kLongest = 4.0;           // and out

/// Direction in which the slices push the stick over.
struct Direction {
  Eigen::Vector3d u;
  double norm;  ///< distance from the pivot to the point that the slices push
};

/// A stick in a gimbal. The slices push it at the height `arm` over the pivot,
/// u = (q0, q1, arm) / norm, and its tip is at (length + q2) u; q2 is 0 with two slices.
class Stick final : public Kinematics {
 public:
  Stick(int slices, double arm, double length)
      : Kinematics(slices, slices), arm_(arm), length_(length) {}

  ERGOTIC_REALTIME bool forward(const double* q,
                                double* x,
                                double* jacobian) const noexcept override {
    const Direction direction = directionOf(q);
    const double reach = reachOf(q);
    if (!(direction.u.z() >= kCosineOfMostTilt && reach >= kShortest * length_ &&
          reach <= kLongest * length_)) {  // NaN, too
      return false;
    }
    const Eigen::Vector3d tip = reach * direction.u - length_ * Eigen::Vector3d::UnitZ();
    std::copy_n(tip.data(), coordinates(), x);
    // du/dq = (1 - u u^T) (e_x, e_y) / norm; along the stick: u
    const Eigen::Vector3d& u = direction.u;
    Eigen::Matrix3d columns =
        (Eigen::Matrix3d::Identity() - u * u.transpose()) * (reach / direction.norm);
    columns.col(2) = u;
    for (int row = 0; row < coordinates(); ++row) {
      for (int column = 0; column < slices(); ++column) {
        jacobian[row * slices() + column] = columns(row, column);
      }
    }
    return true;
  }

  /// Turned about the pivot, slid along itself.
  ERGOTIC_REALTIME Eigen::Isometry3d pose(const double* q) const noexcept override {
    const Eigen::Vector3d u = directionOf(q).u;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), u).toRotationMatrix();
    pose.translation() = (reachOf(q) - length_) * u;
    return pose;
  }

 private:
  Direction directionOf(const double* q) const noexcept {
    const Eigen::Vector3d pushed(q[0], q[1], arm_);
    const double norm = pushed.norm();
    return {pushed / norm, norm};
  }
  double reachOf(const double* q) const noexcept {
    return slices() == 3 ? length_ + q[2] : length_;
  }

  double arm_;
  double length_;
};

}  // namespace

std::unique_ptr<Kinematics> makeStick(const EndEffectorConfig& config) {
  return std::make_unique<Stick>(static_cast<int>(config.slices.size()), config.arm, config.length);
}

}  // namespace ergotic::tgr
