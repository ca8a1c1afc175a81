// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// A scene in which nothing is left to choose, and what was chosen.
struct Settled {
  scene::Scene scene;
  /// `file:line:col: note: ...`, one per choice: what, why, and the error it is predicted to make.
  std::vector<std::string> notes;
};

/// Makes every choice that a scene leaves to the station, now that the rates are known: the rate of
/// sections with `rate: auto`, the springs of strings with a pitch, chaplets of filtered links, the
/// scheme of `auto` links. What the scene itself says is kept; new modules and links come last, so
/// that indices stay. Realtime: no. \throws TextError if something asked for is impossible at these
/// rates (C2 below R = 4)
Settled settle(scene::Scene scene, const Rates& rates);

}  // namespace ergotic::physics
