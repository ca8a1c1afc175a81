// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ergotic/tgr/end_effector.hpp"
#include "scene/limits.hpp"

/// What each type of end-effector is described by, said once for the reader, the writer and the
/// makers.
namespace ergotic::tgr {

/// One number of a type.
struct Dimension {
  const char* key;  ///< in YAML
  double EndEffectorConfig::*member;
  scene::Limits limits;
};

/// What stands on how many slices, and what it measures.
struct TypeTraits {
  const char* name;
  int fewest_slices;
  int most_slices;
  std::vector<Dimension> dimensions;
  std::unique_ptr<Kinematics> (*make)(const EndEffectorConfig& config);  ///< of legal numbers
};
const TypeTraits& traitsOf(EndEffectorType type);
/// In the order of the enumeration.
const std::vector<std::string>& typeNames();

constexpr int kFewestPoints = 3;  ///< of a handle
constexpr int kMostPoints = Kinematics::kMaxCoordinates / 3;
constexpr scene::Limits kPointLimits{"m", -1.0, 1.0};

/// Coordinates of one whose slices and points are given.
std::size_t coordinatesOf(const EndEffectorConfig& config);

/// Roll, pitch and yaw: a rotation as turns about fixed axes, x first. Where pitch is a right angle
/// the other two turn about one line; roll then makes up for whatever yaw is.
Eigen::Vector3d fixedAxisAngles(const Eigen::Matrix3d& rotation);

/// `2 slices`, `2 to 3 slices`
std::string sliceCountText(const TypeTraits& traits);

}  // namespace ergotic::tgr
