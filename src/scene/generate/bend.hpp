// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// Adds a link of many ends, and the springs `<name>.0` ... that it is stepped as: with sum u = 0
/// its energy K e^2/2 is that of springs -u_i u_j K between any two ends, which rest where
/// x_i - x_j = (u_i - u_j) rest_length / sum u^2.
/// \param bend  by the rules of bend_rules.hpp; all but `first_lia`
/// \throws TextError if the name is taken
void addBend(SceneBuilder& builder, Bend bend);

}  // namespace ergotic::scene
