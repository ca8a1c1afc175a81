// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "rviz/model_shape.hpp"

namespace ergotic::panel {

/// Red, green, blue, 0...1.
using Tint = Eigen::Vector3f;

/// The colour of a look, without light.
Tint tintOf(ModuleLook look);
/// Colours of sections in turn, as the station's markers have them.
Tint tintOfSection(std::size_t section);

/// Light that comes with the camera, from a little above it, on things that are seen from both
/// sides. It is worked out here and not by the renderer, whose lights are those of the user.
class ModelLight {
 public:
  /// \param eye  of the camera \param middle  of what it looks at \param up  all of frame `model`
  ModelLight(const Eigen::Vector3f& eye, const Eigen::Vector3f& middle, const Eigen::Vector3f& up);

  /// Brightness of a surface with this normal of any length, at a place: about 0.3...1.2.
  float on(const Eigen::Vector3f& normal, const Eigen::Vector3f& place) const;

 private:
  Eigen::Vector3f eye_;
  Eigen::Vector3f to_light_;  // of length 1
};

/// Colour with red, green, blue, alpha in the order of the memory, 8 bits each.
/// \param light  see ModelLight \param glow  -1...1, on top of the light: warm, or cold below 0
/// \param is_stale  whether it is greyed, as nothing is known of its motion
std::uint32_t colourOf(const Tint& tint, float light, float glow, bool is_stale);

}  // namespace ergotic::panel
