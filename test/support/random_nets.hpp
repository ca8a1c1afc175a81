// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

namespace ergotic::test {

/// A scene of linear networks of all shapes that kernels know and of some that they do not: 2...600
/// modules in several sections, heard by position, velocity and force. \return the same for the
/// same seed
struct RandomNets {
  scene::Scene scene;
  bool is_plain = false;  ///< has neither cells, medium nor inputs
};

/// \param has_two_rates  sections of other rates, slow hammers, and links across
RandomNets randomNets(unsigned seed, bool has_two_rates);

}  // namespace ergotic::test
