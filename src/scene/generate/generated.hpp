// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// A module at rest at its place.
Mat generatedMat(
    const SceneBuilder& builder, int section, Name name, const Eigen::Vector3d& rest, Place place);

/// Stem of the names of all links of a generator.
Name linkStem(const std::string& generator);

/// \param stem  of all links of the generator
Lia generatedLink(const Name& stem, int index, int a, int b, Place place);

}  // namespace ergotic::scene
