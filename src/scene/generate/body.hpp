// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// Pitch, inharmonicity and decay that a body may be asked for.
struct BodyWish {
  double pitch_hz = 0.0;
  int pitch_of = 1;             ///< the partial that sounds at it, from 1
  double inharmonicity = -1.0;  ///< inharmonicity of strings with bends, see Tuning
  bool is_string = false;  ///< a string, whose modes have f_j = j f_1 sqrt((1 + B j^2)/(1 + B))
  /// (partial from 1, s): none, one, or two of different partials.
  std::vector<std::pair<int, double>> t60;
};

constexpr int kMaxPartials = 40;  ///< most partials that a network can be asked for

/// Type of a mass that may lose: a matched cell if a decay is wanted.
inline MatType massTypeOf(const BodyWish& wish) {
  return wish.t60.empty() ? MatType::kMass : MatType::kCell;
}

/// Looks at its modes again: `modes`, as many as it had, and `top`.
void findModes(const Scene& scene, Tuning& body);

/// Begins a body: whatever is added to the scene until `finishBody` is a part of it.
Tuning beginBody(const SceneBuilder& builder, const std::string& name, Place place);

/// Takes what was added since as the body.
void endBody(const SceneBuilder& builder, Tuning& body);

/// Ends it, looks at its modes, and leaves to `settle` how stiff it is. Until then
/// its springs are those of the same partial in continuous time, and its losses none.
/// \param body  from `beginBody`, with its `rigid` motions and `ratios`
/// \throws TextError if it has fewer modes than were asked for, or cannot decay so
void finishBody(SceneBuilder& builder, Tuning body, const BodyWish& wish);

/// Factors for what a body is made of.
struct BodyScale {
  double springs = 1.0;
  double bends = 1.0;
  double dampers = 1.0;
  double loss = 0.0;  ///< loss of every cell to the ground, over its mass, 1/time_unit
};

/// Multiplies the links, and gives the cells their loss; the modes of the body follow.
void scaleBody(Scene& scene, Tuning& body, const BodyScale& scale);

}  // namespace ergotic::scene
