// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <sstream>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "lab/lib/accuracy.hpp"

namespace ergotic::tools {
namespace {

constexpr double kWallSeconds = 2.0;

/// A slice on a wall that is the edge of a gestural net, beside a string that is heard.
std::string wallScene(double stiffness) {
  std::ostringstream yaml;
  yaml << "ergotic: 1\n"
          "sections: {string: {rate: audio}, table: {rate: gestural}}\n"
          "mats:\n"
          "  key: {type: slice, section: table}\n"
          "  wall: {type: ground, section: table}\n"
          "generators:\n"
          "  - {type: string, name: s, section: string, masses: 80, mass: 3.0e-5, frequency: 110, "
          "to: [0.65, 0], pluck: {at: 0.13, height: 0.001}}\n"
          "  - {type: mesh, name: net, section: table, rows: 16, columns: 16, spacing: 0.01, "
          "mass: 0.001, stiffness: 100}\n"
          "lias:\n"
          "  touch: {type: spring, between: [key, wall], stiffness: "
       << stiffness
       << "}\n"
          "ports: {key: {mat: key, slice: 0}}\n"
          "outputs: {v: {at: s@0.37, quantity: velocity, channel: 1}}\n";
  return yaml.str();
}

std::unique_ptr<physics::Instrument> bareWall(double stiffness, const physics::Rates& rates) {
  std::ostringstream yaml;
  yaml << "ergotic: 1\n"
          "sections: {table: {rate: gestural}}\n"
          "mats:\n"
          "  key: {type: slice}\n"
          "  wall: {type: ground}\n"
          "lias: {touch: {type: spring, between: [key, wall], stiffness: "
       << stiffness << "}}\nports: {key: {mat: key, slice: 0}}\n";
  const physics::Settled settled = physics::settle(scene::readYaml(yaml.str(), "wall"), rates);
  return physics::compile(settled.scene, rates, physics::Precision::kDouble);
}

/// A device (0.3 kg, 2 N s/m) thrown at the wall, whose force is given one tick late and held;
/// between ticks it moves exactly. True if it calms down.
bool calmsDown(double stiffness, const physics::Rates& rates) {
  constexpr double kMass = 0.3;
  const double kDamping = physics::DeviceTraits{}.damping;
  const auto wall = bareWall(stiffness, rates);
  const double t = 1.0 / rates.gesturalHz();
  const double decay = std::exp(-kDamping / kMass * t);
  const double glide = kMass / kDamping * (1.0 - decay);
  double x = 0.0;
  double v = 1.0;
  double force = 0.0;
  const auto ticks = static_cast<int>(kWallSeconds / t);
  double energy[2] = {0.0, 0.0};  // of both halves
  for (int n = 0; n < ticks; ++n) {
    const double late = force;
    wall->tick({&x, &force, nullptr, nullptr});
    energy[2 * n / ticks] += stiffness * x * x + kMass * v * v;
    x += glide * v + (t - glide) * late / kDamping;
    v = decay * v + (1.0 - decay) * late / kDamping;
  }
  return energy[1] < energy[0];
}

double stiffestPlayed(const physics::Rates& rates) {
  double stable = 10.0;
  double unstable = 1e6;
  while (unstable / stable > 1.001) {
    const double middle = std::sqrt(stable * unstable);
    (calmsDown(middle, rates) ? stable : unstable) = middle;
  }
  return stable;
}

double stiffestCertified(const physics::Rates& rates) {
  const physics::Settled settled =
      physics::settle(scene::readYaml(wallScene(100.0), "wall"), rates);
  return physics::certify(settled.scene, rates).ports.at(0).stiffness_limit;
}

}  // namespace

void measureWalls(const Sink& sink) {
  for (const int ratio : {1, 2, 4, 7, 14, 28, 44}) {
    const physics::Rates rates{kRateHz, ratio};
    const double played = stiffestPlayed(rates);
    const double certified = stiffestCertified(rates);
    for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
      Experiment experiment(wallScene(certified), rates, precision);
      const PlayCost cost = experiment.cost(0.1);
      const auto say = [&](const char* family, double stiffness) {
        sink({"wall", "compliance of the stiffest wall", family, precision, rates, 0, 0.0,
              1e3 / stiffness, "mm/N", cost});
      };
      say("played", played);
      say("certified", certified);
    }
  }
}

}  // namespace ergotic::tools
