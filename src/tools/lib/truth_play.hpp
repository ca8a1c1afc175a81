// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/physics/options.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "ergotic/scene/truth.hpp"
#include "tools/lib/measures.hpp"

namespace ergotic::tools {

/// A scene that was played for its truths.
struct PlayedTruth {
  std::vector<Sound> sounds;  ///< requested sounds
  double begin_s = 0.0;       ///< end of the tap or pluck
  double imbalance =
      0.0;  ///< largest residual of the energy accounts, if kept, of the most stored energy
};

/// True if one performance serves both.
bool arePlayedAlike(const scene::Truth& a, const scene::Truth& b);

/// Plays a scene by itself, tapped or plucked, or by the hand of a gesture file.
/// \param truth    how \param outputs  what is listened to, with its gain, one sound each
/// \param seconds  after the tap or pluck
/// \throws Exception, TextError
PlayedTruth playTruth(scene::Scene scene,
                      const scene::Truth& truth,
                      const std::vector<scene::Output>& outputs,
                      double seconds,
                      const physics::Rates& rates,
                      const physics::CompileOptions& options);

}  // namespace ergotic::tools
