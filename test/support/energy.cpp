// SPDX-License-Identifier: BSD-3-Clause
#include "support/energy.hpp"

#include <numeric>
#include <random>

#include "support/one_by_one.hpp"
#include "support/test.hpp"

namespace ergotic::test {

physics::Energies energiesOf(const Player& player) {
  physics::Energies energies = player.instrument->makeEnergies();
  player.instrument->readEnergies(energies);
  return energies;
}

namespace {

/// \param visit  channel, mass, velocity
template <class Visit>
void visitVelocities(const Player& player, std::size_t n, const Visit& visit) {
  const std::vector<scene::Mat>& mats = player.instrument->scene().mats;
  for (std::size_t c = 0; c < std::min(player.heard.size(), 3 * mats.size()); ++c) {
    if (mats[c / 3].type == scene::MatType::kMass) {
      visit(c, mats[c / 3].mass.factor, player.heard[c][n]);
    }
  }
}

}  // namespace

std::vector<physics::GuardedState<double>> guardsOf(const Player& player) {
  return numbersOf<physics::GuardedState<double>>(*player.instrument, "guarded0");
}

double heatOf(const std::vector<physics::GuardedState<double>>& guards) {
  return std::accumulate(guards.begin(), guards.end(), 0.0,
                         [](double sum, const auto& guard) { return sum + guard.lost; });
}

double energyBetweenSteps(const Player& player,
                          const std::vector<physics::GuardedState<double>>& guards) {
  double energy = 0.0;
  visitVelocities(player, player.heard[0].size() - 1,
                  [&](std::size_t, double kg, double v) { energy += 0.5 * kg * v * v; });
  return std::accumulate(guards.begin(), guards.end(), energy,
                         [](double sum, const auto& guard) { return sum + guard.tank; });
}

Eigen::Vector3d momentumOf(const Player& player, std::size_t n) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  visitVelocities(player, n, [&](std::size_t channel, double kg, double v) {
    sum[static_cast<int>(channel % 3)] += kg * v;
  });
  return sum;
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
