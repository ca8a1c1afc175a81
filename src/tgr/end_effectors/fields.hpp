// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ergotic/tgr/end_effector.hpp"
#include "scene/limits.hpp"

/// Parameters that describe each type of end-effector, shared by the reader, the writer and the
/// makers.
namespace ergotic::tgr {

/// One numeric parameter of a type.
struct Dimension {
  const char* key;  ///< in YAML
  double EndEffectorConfig::*member;
  scene::Limits limits;
};

/// Name, number of slices and dimensions of a type.
struct TypeTraits {
  const char* name;
  int fewest_slices;
  int most_slices;
  std::vector<Dimension> dimensions;
  /// Maker, for numbers within their ranges.
  std::unique_ptr<Kinematics> (*make)(const EndEffectorConfig& config);
};
const TypeTraits& traitsOf(EndEffectorType type);
/// Names of the types, in the order of the enumeration.
const std::vector<std::string>& typeNames();

constexpr int kFewestPoints = 3;  ///< number of points of a handle
constexpr int kMaxPoints = Kinematics::kMaxCoordinates / 3;
constexpr scene::Limits kPointLimits{"m", -1.0, 1.0};

/// Number of coordinates of an end-effector with given slices and points.
std::size_t coordinatesOf(const EndEffectorConfig& config);

/// Roll, pitch and yaw: a rotation as turns about fixed axes, x first. Where pitch is a right angle
/// the other two turn about one line; roll then makes up for whatever yaw is.
Eigen::Vector3d fixedAxisAngles(const Eigen::Matrix3d& rotation);

/// `2 slices`, `2 to 3 slices`
std::string sliceCountText(const TypeTraits& traits);

}  // namespace ergotic::tgr
