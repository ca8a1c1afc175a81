// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>
#include <random>

#include "support/test.hpp"
#include "tgr/rig_scenes.hpp"

namespace ergotic::test {

using Pose = std::array<double, tgr::Kinematics::kMaxSlicesOfOne>;
using Coordinates = std::array<double, tgr::Kinematics::kMaxCoordinates>;
using JacobianRows =
    std::array<double, tgr::Kinematics::kMaxCoordinates * tgr::Kinematics::kMaxSlicesOfOne>;

/// One of each kind of end-effector, and how far its slices go in tests.
struct KinematicsCase {
  const char* name;
  tgr::EndEffectorConfig config;
  double stroke = 0.03;  ///< m, either way
  friend std::ostream& operator<<(std::ostream& to, const KinematicsCase& c) {
    return to << c.name;
  }
};

inline std::vector<KinematicsCase> kinematicsCases() {
  using Type = tgr::EndEffectorType;
  const auto make = [](Type type, std::vector<int> slices) {
    return endEffector(type, std::move(slices), {});
  };
  tgr::EndEffectorConfig key = make(Type::kKey, {0});
  key.lever = 1.7;
  tgr::EndEffectorConfig bow = make(Type::kBow, {0, 1});
  bow.lever = 3.0;
  bow.angle = 0.4;
  tgr::EndEffectorConfig handle = make(Type::kHandle, {0, 1, 2, 3, 4, 5});
  handle.points = {{0.06, 0.0, 0.02}, {-0.03, 0.05, 0.0}, {-0.03, -0.05, 0.01}, {0.0, 0.0, 0.15}};
  return {{"Key", key},
          {"Bow", bow},
          {"Stick2D", make(Type::kStick, {0, 1})},
          {"Stick3D", make(Type::kStick, {0, 1, 2})},
          {"Ball", make(Type::kBall, {0, 1, 2})},
          {"Handle", handle}};
}

/// Poses of the slices anywhere within the stroke, and whether the linkage can be there.
class RandomPoses {
 public:
  explicit RandomPoses(const KinematicsCase& c, unsigned seed = 1)
      : kinematics_(tgr::makeKinematics(c.config, "hands.yaml")),
        random_(seed),
        stroke_(-c.stroke, c.stroke) {}

  const tgr::Kinematics& kinematics() const { return *kinematics_; }
  double anyNumber() { return number_(random_); }
  const Pose& q() const { return q_; }
  const Coordinates& x() const { return x_; }
  double jacobian(int coordinate, int slice) const {
    return rows_[static_cast<std::size_t>(coordinate * kinematics_->slices() + slice)];
  }

  /// \return false if it is beyond the workspace
  bool next() {
    for (double& q : q_) {
      q = stroke_(random_);
    }
    return kinematics_->forward(q_.data(), x_.data(), rows_.data());
  }
  void nextWithin() {
    while (!next()) {
    }
  }

 private:
  std::unique_ptr<tgr::Kinematics> kinematics_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> stroke_;
  std::uniform_real_distribution<double> number_{-1.0, 1.0};
  Pose q_{};
  Coordinates x_{};
  JacobianRows rows_{};
};

}  // namespace ergotic::test
