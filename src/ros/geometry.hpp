// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "ergotic/scene/scene.hpp"

namespace ergotic::node {

/// Where a module rests, m, in frame `model`.
inline Eigen::Vector3d restOf(const scene::Scene& scene, const scene::Mat& mat) {
  const auto& section = scene.sections[static_cast<std::size_t>(mat.section)];
  return section.pose * Eigen::Vector3d(mat.rest.x(), mat.rest.y(), mat.rest.z());
}

/// Unit direction in which the modules of a section move, in frame `model`.
inline Eigen::Vector3d axisOf(const scene::Section& section) {
  return section.pose.linear().col(0);
}

}  // namespace ergotic::node
