// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// Adds a stretch, and beside each of its springs a cubic link `<name>.0`, `<name>.1` ... of
/// Q = K c/(2 a^2), all in one tank: with S the mean of (e/a)^2/2, weighted by K, they add K c S to
/// every K. \pre tank.is_mean, and its springs exist
void addStretch(SceneBuilder& builder, Tank tank);

/// Gives these links the Q of their springs as these are now.
void settleStretches(Scene& scene);

}  // namespace ergotic::scene
