// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// What a format means by a clipped cubic law: f = K e + Q e^3 up to the tipping point, K_limit e
/// beyond.
enum class ClippedLaw {
  kMdl,        ///< tipping point sqrt(K_limit - K) / Q, 0.3 K_limit more damping beyond
  kContinuous  ///< tipping point sqrt((K_limit - K) / Q), where the two meet
};

/// Completes a link of type kClippedCubic or kCubicContact; one without a cube, or with K beyond
/// K_limit already, becomes the straight link that it is. Others are left alone.
/// \pre K, Q and K_limit do not depend on parameters
void completeClippedLaw(Lia& lia, ClippedLaw law);

}  // namespace ergotic::scene
