// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scene/generate/modal_body.hpp"

namespace ergotic::scene {

/// Shape of a bell, a glass or a ring: its rim, and from there a cone.
struct RingShape {
  double radius = 0.1;     ///< m, of the rim
  double height = 0.0;     ///< m along x, from the rim to where it does not move; 0: a rim alone
  std::vector<int> waves;  ///< [partials] round the rim: cos(n u), or sin(n u) for -n
};

/// Gives a body of modes, whose first cell rests in the middle of the rim, the outline of a ring:
/// what partial j moves at the angle u of the rim is cos(n u). Its places are shown evenly round
/// it. \pre as many waves as partials
void setRing(ModalSpec& spec, const RingShape& ring);

}  // namespace ergotic::scene
