// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/laws/energy_stable_force.hpp"
#include "physics/layout/layout.hpp"
#include "support/scene_builder.hpp"

namespace ergotic::test {

/// The energy accounts of what has been played so far.
physics::Energies energiesOf(const Player& player);
/// J, of all sections, without their signs: that of the energy accounts is below 0 where steps are
/// opposite.
double kineticEnergy(const Player& player);

/// The kinetic energy M v^2/2 of all that forces move, each with the velocity of its last step, and
/// the potential energy, beyond what springs hold that rest stretched. The kinetic energy of the
/// energies, from one step and the next, is below 0 where these are opposite.
class Swing {
 public:
  explicit Swing(const physics::Instrument& instrument);
  /// J. \pre the same instrument, in double precision \param energies  as they are now
  double energyOf(const physics::Instrument& instrument, const physics::Energies& energies) const;

 private:
  physics::Layout layout_;
  double at_rest_;
};

/// Of all masses at frame n; the velocity of mass m is heard on the channels from 3 m on.
Eigen::Vector3d momentumOf(const Player& player, std::size_t n);

/// What the energy-stable links remember. \pre double, one group of them
std::vector<physics::EnergyStableState<double>> tankStatesOf(const Player& player);
/// What they have lost so far, J.
double heatOf(const std::vector<physics::EnergyStableState<double>>& tanks);
/// Energy between two steps, of nothing but masses, heard as above, and energy-stable links, J. The
/// energy accounts hold half of a step's work back. \param tanks  before the last tick
double energyBetweenSteps(const Player& player,
                          const std::vector<physics::EnergyStableState<double>>& tanks);

/// Plays with hands that move at random and noise in the inputs, and reads the energy accounts
/// after every `every` ticks. \return the largest residual, of the largest energy stored; infinite
/// if the model blew up
double imbalanceOf(Player& player, int ticks, int every = 1);

}  // namespace ergotic::test
