// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/laws/guarded_force.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::test {

/// The books of what has been played so far.
physics::Energies energiesOf(const Player& player);

/// What the guarded links remember. They lose energy step by step, while the books hold half of a
/// step's work back. \pre double, one group of them
std::vector<physics::GuardedState<double>> guardsOf(const Player& player);
/// What they have lost so far, in units of force times m.
double heatOf(const std::vector<physics::GuardedState<double>>& guards);

/// Of all masses at frame n; the velocity of mass m is heard on the channels from 3 m on.
Eigen::Vector3d momentumOf(const Player& player, std::size_t n);

/// Plays with hands that move at random and noise in the inputs, and reads the books after every
/// `every` ticks. \return the largest residual, of the largest energy stored; infinite
/// if the model blew up
double imbalanceOf(Player& player, int ticks, int every = 1);

}  // namespace ergotic::test
