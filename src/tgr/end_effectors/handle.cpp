// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "algebra/decompositions.hpp"
#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/realtime.hpp"
#include "scene/limits.hpp"
#include "tgr/end_effectors/fields.hpp"
#include "tgr/end_effectors/linkage.hpp"
#include "tgr/end_effectors/makers.hpp"

namespace ergotic::tgr {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
/// Sizes at run time, none on the heap: unrolled, this would take a sanitizing compiler many
/// minutes.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using Solver = Eigen::PartialPivLU<Square>;
using Circle = Eigen::Matrix<double, 3, 6>;

constexpr int kRods = 6;
constexpr double kHalfPair =
    kPi / 18.0;  // slices, and ends of rods, stand in pairs 20 degrees wide
constexpr int kMaxIterations = 12;
constexpr double kConverged = 1e-9;  // last step over rod; the error left is about its square
constexpr double kCosineOfHandleTilt = 0.5;
constexpr double kWorstCondition = 30.0;  // at rest; turns count times platform_radius
constexpr double kThinnest = 0.005;       // m, rms of the points about the line they are nearest to

/// Rod 2k and 2k + 1 leave the base beside 120 k degrees and end beside 120 k -+ 60 degrees.
double baseAngle(int rod) {
  return 2.0 / 3.0 * kPi * (rod / 2) + (rod % 2 == 0 ? -kHalfPair : kHalfPair);
}
double platformAngle(int rod) {
  const double to_gap = kPi / 3.0 - kHalfPair;
  return 2.0 / 3.0 * kPi * (rod / 2) + (rod % 2 == 0 ? -to_gap : to_gap);
}

Circle onCircle(double radius, double (*angle)(int)) {
  Circle points;
  for (int i = 0; i < kRods; ++i) {
    points.col(i) << radius * std::cos(angle(i)), radius * std::sin(angle(i)), 0.0;
  }
  return points;
}

/// Squares of the singular values, ascending.
Eigen::VectorXd squaredGains(const Eigen::MatrixXd& matrix) {
  return algebra::symmetricEigenvalues(matrix.transpose() * matrix);
}

/// Position of the platform, and of its rods.
struct Stance {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d centre;
  Circle arms;  ///< vectors from the centre to the ends of the rods
  Circle rods;  ///< vectors from the slices to the other ends of the rods

  /// Derivatives of half the squared rod lengths by translation and rotation of the platform.
  Matrix6d constraints() const noexcept {
    Matrix6d rows;
    for (int i = 0; i < kRods; ++i) {
      const Eigen::Vector3d rod = rods.col(i);
      const Eigen::Vector3d arm = arms.col(i);
      rows.row(i) << rod.transpose(), arm.cross(rod).transpose();
    }
    return rows;
  }
};

/// A platform on six rods whose lower ends the slices move along z (a hexapod with six inclined
/// rods of one length). What the points of its handle do is what it measures.
class Handle final : public Kinematics {
 public:
  explicit Handle(const EndEffectorConfig& config)
      : Kinematics(kRods, 3 * static_cast<int>(config.points.size())),
        rod_(config.rod),
        platform_radius_(config.platform_radius),
        base_(onCircle(config.base_radius, baseAngle)),
        platform_(onCircle(config.platform_radius, platformAngle)),
        rest_(restHeight(config.rod, (platform_.col(0) - base_.col(0)).norm())),
        points_(config.points) {
    const Matrix6d at_rest = scaled(jacobianOf(atRest(0.0)));
    const Eigen::VectorXd squares = squaredGains(at_rest);
    const double condition = std::sqrt(squares[kRods - 1] / squares[0]);
    if (!(condition <= kWorstCondition)) {
      throw Exception("rod = " + scene::numberText(rod_) +
                      " m on these radii holds no platform sideways: condition " +
                      scene::numberText(condition) +
                      ", allowed: <= " + scene::numberText(kWorstCondition));
    }
    most_gain_ = kMaxGain * at_rest.norm();
  }

  ERGOTIC_REALTIME bool forward(const double* q,
                                double* x,
                                double* jacobian) const noexcept override {
    Stance stance;
    if (!solve(q, stance)) {
      return false;
    }
    const Matrix6d platform = jacobianOf(stance);
    if (!(scaled(platform).norm() <= most_gain_)) {
      return false;
    }
    const Eigen::Vector3d moved = stance.centre - rest_ * Eigen::Vector3d::UnitZ();
    for (const Eigen::Vector3d& point : points_) {
      const Eigen::Vector3d arm = stance.rotation * point;
      Eigen::Map<Eigen::Vector3d>{x} = moved + (arm - point);
      x += 3;
      Eigen::Map<Eigen::Matrix<double, 3, kRods, Eigen::RowMajor>> rows(jacobian);
      for (int i = 0; i < kRods; ++i) {
        const Eigen::Vector3d turning = platform.block<3, 1>(3, i);
        rows.col(i) = platform.block<3, 1>(0, i) + turning.cross(arm);
      }
      jacobian += 3 * kRods;
    }
    return true;
  }

  ERGOTIC_REALTIME Eigen::Isometry3d pose(const double* q) const noexcept override {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    Stance stance;
    if (solve(q, stance)) {
      pose.linear() = stance.rotation;
      pose.translation() = stance.centre - rest_ * Eigen::Vector3d::UnitZ();
    }
    return pose;
  }

 private:
  Stance atRest(double height) const noexcept {
    Stance stance;
    stance.rotation.setIdentity();
    stance.centre << 0.0, 0.0, rest_ + height;
    stance.arms = platform_;
    stance.rods = (platform_ - base_).colwise() + rest_ * Eigen::Vector3d::UnitZ();
    return stance;
  }

  void place(const double* q, Stance& stance) const noexcept {
    stance.arms = stance.rotation * platform_;
    stance.rods = (stance.arms - base_).colwise() + stance.centre;
    stance.rods.row(2) -= Eigen::Map<const Vector6d>(q).transpose();
  }

  /// Newton's method on the lengths of the rods, from the untilted platform over all slices.
  /// \return false if it does not converge, or to where no rod may be
  bool solve(const double* q, Stance& stance) const noexcept {
    stance = atRest(Eigen::Map<const Vector6d>(q).mean());
    for (int n = 0; n < kMaxIterations; ++n) {
      place(q, stance);
      const Vector6d error =
          0.5 * (stance.rods.colwise().squaredNorm().array() - rod_ * rod_).matrix().transpose();
      const Vector6d step = Solver(stance.constraints()).solve(-error);
      const Eigen::Vector3d turn = step.tail<3>();
      const double angle = turn.norm();
      const double size = std::max(step.head<3>().norm(), platform_radius_ * angle);
      if (!(size <= rod_)) {  // NaN, too
        return false;
      }
      stance.centre += step.head<3>();
      if (angle > 0.0) {
        stance.rotation = Eigen::AngleAxisd(angle, turn / angle) * stance.rotation;
      }
      if (size <= kConverged * rod_) {
        place(q, stance);
        return stance.rods.row(2).minCoeff() >= kFlattestRod * rod_ &&
               stance.rotation(2, 2) >= kCosineOfHandleTilt;
      }
    }
    return false;
  }

  /// Motion and turning of the platform by the slices: l_i (v + w x arm_i - e_z dq_i) = 0.
  static Matrix6d jacobianOf(const Stance& stance) noexcept {
    const Matrix6d heights = stance.rods.row(2).asDiagonal();
    return Solver(stance.constraints()).solve(heights);
  }

  Matrix6d scaled(Matrix6d jacobian) const noexcept {
    jacobian.bottomRows<3>() *= platform_radius_;
    return jacobian;
  }

  double rod_;
  double platform_radius_;
  Circle base_;
  Circle platform_;
  double rest_;  ///< height of the platform over slices at rest
  double most_gain_ = 0.0;
  std::vector<Eigen::Vector3d> points_;
};

void checkPoints(const std::vector<Eigen::Vector3d>& points) {
  const int count = static_cast<int>(points.size());
  if (count < kFewestPoints || count > kMaxPoints) {
    throw Exception(std::to_string(count) + " points, allowed: " + std::to_string(kFewestPoints) +
                    " to " + std::to_string(kMaxPoints));
  }
  Eigen::Matrix3Xd all(3, count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d& point = points[static_cast<std::size_t>(i)];
    for (const double value : point) {
      if (!kPointLimits.hold(value)) {
        throw Exception(scene::outOfRange("points", value, kPointLimits));
      }
    }
    all.col(i) = point;
  }
  all.colwise() -= all.rowwise().mean().eval();
  const double width = std::sqrt(squaredGains(all.transpose())[1] / count);
  if (width < kThinnest) {
    throw Exception("its points lie within " + scene::numberText(width) +
                    " m (rms) of a line and do not feel turns about it, allowed: >= " +
                    scene::numberText(kThinnest) + " m");
  }
}

}  // namespace

std::unique_ptr<Kinematics> makeHandle(const EndEffectorConfig& config) {
  checkPoints(config.points);
  return std::make_unique<Handle>(config);
}

}  // namespace ergotic::tgr
