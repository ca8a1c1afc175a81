// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "ergotic/rt/realtime.hpp"
#include "tgr/end_effectors/makers.hpp"

namespace ergotic::tgr {
namespace {

/// A lever: x = lever q.
class Key final : public Kinematics {
 public:
  explicit Key(double lever) : Kinematics(1, 1), lever_(lever) {}

  ERGOTIC_REALTIME bool forward(const double* q,
                                double* x,
                                double* jacobian) const noexcept override {
    if (!std::isfinite(q[0])) {
      return false;
    }
    x[0] = lever_ * q[0];
    jacobian[0] = lever_;
    return true;
  }

  ERGOTIC_REALTIME Eigen::Isometry3d pose(const double* q) const noexcept override {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().z() = lever_ * q[0];
    return pose;
  }

 private:
  double lever_;
};

}  // namespace

std::unique_ptr<Kinematics> makeKey(const EndEffectorConfig& config) {
  return std::make_unique<Key>(config.lever);
}

}  // namespace ergotic::tgr
