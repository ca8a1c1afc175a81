// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::test {

/// A scene that a throw of dice made, and what they meant it to be.
struct RandomScene {
  scene::Scene scene;  ///< valid, not settled
  physics::Rates rates;
  bool has_two_rates = false;
  bool is_nonlinear = false;
  bool is_near_limit = false;  ///< lambda of a section is 3.6...3.99
  bool is_lossless = false;    ///< no damping, and no friction
};

/// A string, cells and loose masses at the audio rate, most often tied to a chain of slow masses,
/// by springs that end on modules or on points of the string; any geometry; half with nonlinear
/// links of `scheme: auto`. Nothing drives it: it starts to move. \return the same scene for the
/// same seed
RandomScene randomScene(unsigned seed);

}  // namespace ergotic::test
