// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/scene_builder.hpp"

namespace ergotic::test {

/// The books of what has been played so far.
physics::Energies energiesOf(const Player& player);

/// Plays with hands that move at random and noise in the inputs, and reads the books after every
/// `every` ticks. \return the largest residual, of the largest energy stored; infinite
/// if the model blew up
double imbalanceOf(Player& player, int ticks, int every = 1);

}  // namespace ergotic::test
