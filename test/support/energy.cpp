// SPDX-License-Identifier: BSD-3-Clause
#include "support/energy.hpp"

#include <random>

#include "support/test.hpp"

namespace ergotic::test {

physics::Energies energiesOf(const Player& player) {
  physics::Energies energies = player.instrument->makeEnergies();
  player.instrument->readEnergies(energies);
  return energies;
}

double imbalanceOf(Player& player, int ticks, int every) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  physics::Energies energies = player.instrument->makeEnergies();
  double residual = 0.0;
  double stored = 0.0;
  for (int n = 0; n < ticks; ++n) {
    for (double& x : player.positions) {
      x += 1e-4 * noise(random);
    }
    for (double& x : player.inputs) {
      x = noise(random);
    }
    player.tick();
    if (n % every == 0 || n == ticks - 1) {
      player.instrument->readEnergies(energies);
      residual = std::max(residual, std::abs(energies.residual));
      stored = std::max(stored, std::abs(energies.stored));
    }
  }
  return player.instrument->isFinite() ? residual / stored
                                       : std::numeric_limits<double>::infinity();
}

}  // namespace ergotic::test
