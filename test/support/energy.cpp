// SPDX-License-Identifier: BSD-3-Clause
#include "support/energy.hpp"

#include <numeric>
#include <random>

#include "at.hpp"
#include "support/one_by_one.hpp"
#include "support/test.hpp"

namespace ergotic::test {

physics::Energies energiesOf(const Player& player) {
  physics::Energies energies = player.instrument->makeEnergies();
  player.instrument->readEnergies(energies);
  return energies;
}

double kineticEnergy(const Player& player) {
  double sum = 0.0;
  for (const physics::SectionEnergy& section : energiesOf(player).sections) {
    sum += std::abs(section.kinetic);
  }
  return sum;
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

std::vector<physics::EnergyStableState<double>> tankStatesOf(const Player& player) {
  return numbersOf<physics::EnergyStableState<double>>(*player.instrument, "energy_stable0");
}

double heatOf(const std::vector<physics::EnergyStableState<double>>& tanks) {
  return std::accumulate(tanks.begin(), tanks.end(), 0.0,
                         [](double sum, const auto& tank) { return sum + tank.lost; });
}

double energyBetweenSteps(const Player& player,
                          const std::vector<physics::EnergyStableState<double>>& tanks) {
  double energy = 0.0;
  visitVelocities(player, player.heard[0].size() - 1,
                  [&](std::size_t, double kg, double v) { energy += 0.5 * kg * v * v; });
  return std::accumulate(tanks.begin(), tanks.end(), energy,
                         [](double sum, const auto& tank) { return sum + tank.tank; });
}

namespace {

double potentialOf(const physics::Energies& energies) {
  double energy = 0.0;
  for (const physics::SectionEnergy& section : energies.sections) {
    energy += section.potential;
  }
  for (const physics::CouplingEnergy& coupling : energies.couplings) {
    energy += coupling.stored;
  }
  return energy;
}

double energyAtRest(const physics::Instrument& instrument) {
  scene::Scene scene = instrument.scene();
  for (scene::Mat& mat : scene.mats) {
    mat.push.edit().velocity.setZero();
  }
  return potentialOf(
      energiesOf(Player(physics::compile(scene, instrument.rates(), physics::Precision::kDouble))));
}

}  // namespace

Swing::Swing(const physics::Instrument& instrument)
    : layout_(physics::makeLayout(instrument.scene(), instrument.rates())),
      at_rest_(energyAtRest(instrument)) {}

double Swing::energyOf(const physics::Instrument& instrument,
                       const physics::Energies& energies) const {
  const scene::Scene& scene = instrument.scene();
  const std::vector<double> d = numbersOf<double>(instrument, "d");
  double energy = potentialOf(energies) - at_rest_;
  for (std::size_t m = 0; m < scene.mats.size(); ++m) {
    const scene::Mat& mat = scene.mats[m];
    const physics::SectionRange& range = layout_.sections[at(mat.section)];
    const double rate_hz = instrument.rates().audio_hz / range.divisor;
    const bool is_free = mat.type == scene::MatType::kMass || mat.type == scene::MatType::kCell;
    for (int k = 0; is_free && k < range.dimensions; ++k) {
      const double v = d[at(layout_.slot_of_mat[m] + k * range.stride)] * rate_hz;
      energy += 0.5 * scene.valueOf(mat.mass) * v * v;
    }
  }
  return energy;
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
