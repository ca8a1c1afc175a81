// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// The low-pass chaplet C2: two masses `name.0`, `name.1` and two links `name.link.0`,
/// `name.link.1` hung onto a module that moves at the gestural rate. The last mass is what touches
/// the structure.
struct ChapletSpec {
  std::string name;
  int from = 0;  ///< index of the module that carries it
  int section = 0;
  Value mass;  ///< of both together, kg
  Eigen::Vector2d at{0.0, 0.0};
  Place place;
};

/// Appends the chaplet, tuned to half the scene's gestural rate. \throws TextError if a name is
/// taken
void addChaplet(SceneBuilder& builder, const ChapletSpec& spec);

}  // namespace ergotic::scene
