// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "scene/generate/scene_builder.hpp"
#include "scene/tree/node.hpp"

namespace ergotic::scene {

/// Position and orientation of an instance: `at` and `rotate`.
struct Pose {
  bool is_moved = false;
  bool is_turned = false;
  Eigen::Isometry2d bench = Eigen::Isometry2d::Identity();  ///< pose in scalar sections: y, z
  Eigen::Isometry3d space = Eigen::Isometry3d::Identity();  ///< pose in the others

  /// Pose of an instance in an instance. \pre `inner` is of a use in a definition that has this
  /// pose
  Pose operator*(const Pose& inner) const;
};

/// `at: [y, z]` or `[x, y]`, or `[x, y, z]`; `rotate`: an angle about the axis that is not seen, or
/// `[roll, pitch, yaw]`. \param at, rotate  written out; nullptr: none. \throws TextError
Pose poseOf(const SceneBuilder& builder, const Node* at, const Node* rotate);

/// Moves the places in an element of `mats` or `generators`.
/// \param element   written out
/// \param part      that it is in
/// \param geometry  of its section: `scalar`, `line`, `plane`, `space`
/// \throws TextError where it cannot be turned
void moveTo(const SceneBuilder& builder,
            const Pose& pose,
            const std::string& part,
            const std::string& geometry,
            Node& element);

}  // namespace ergotic::scene
