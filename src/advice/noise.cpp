// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "at.hpp"
#include "physics/certificate/port_links.hpp"

namespace ergotic::physics {
namespace {

/// A slice that moves by itself in each tick, the mass that hangs on it, and what holds that.
struct Hanging {
  PortLinks::Resistance link;
  PortLinks::Resistance behind;
  double mass = 0.0;
  double step = 0.0;  // of the mass
  int steps = 1;      // in a tick
};

/// Of white positions of rms 1.
struct Response {
  double force = std::numeric_limits<double>::infinity();   // on the slice, rms
  double behind = std::numeric_limits<double>::infinity();  // of the mass, rms
};

/// One tick is linear in the mass's position, step and force, the last position and the present
/// one; the covariance of these is what it makes of itself (a Lyapunov equation, by doubling).
Response responseOf(const Hanging& hanging) {
  using Row = Eigen::Matrix<double, 1, 5>;
  constexpr int kDoublings = 60;
  Row y = Row::Unit(0);
  Row d = Row::Unit(1);
  Row f = Row::Unit(2);
  const Row jump = Row::Unit(4) - Row::Unit(3);
  Row force = Row::Zero();
  for (int k = 0; k < hanging.steps; ++k) {
    d += hanging.step * hanging.step / hanging.mass * f;
    y += d;
    const Row moved = (k == 0 ? jump : Row(Row::Zero())) - d;
    const Row pull =
        hanging.link.stiffness * (Row::Unit(4) - y) + hanging.link.damping / hanging.step * moved;
    f = pull - hanging.behind.stiffness * y - hanging.behind.damping / hanging.step * d;
    force -= pull / hanging.steps;
  }
  Eigen::Matrix<double, 4, 5> tick;
  tick << y, d, f, Row::Unit(4);
  Eigen::Matrix4d map = tick.leftCols<4>();
  Eigen::Matrix4d covariance = tick.col(4) * tick.col(4).transpose();
  for (int n = 0; n < kDoublings && map.allFinite(); ++n) {
    covariance += (map * covariance * map.transpose()).eval();
    map = (map * map).eval();
  }
  if (!map.isZero(1e-9)) {
    return {};
  }
  const Eigen::Matrix<double, 1, 4> by_state = force.leftCols<4>();
  return {std::sqrt(by_state * covariance * by_state.transpose() + force[4] * force[4]),
          std::sqrt(covariance(0, 0))};
}

/// Without a filter: F[n] = (K + Z/T) x[n] - Z/T x[n-1].
double forceOf(const PortLinks::Resistance& link, double tick) {
  return std::hypot(link.stiffness + link.damping / tick, link.damping / tick);
}

}  // namespace

double SensorNoise::total() const {
  return std::sqrt(rms * rms + quantum * quantum / 12.0);
}

std::vector<NoiseFloor> noiseFloors(const scene::Scene& scene,
                                    const Rates& rates,
                                    const SensorNoise& noise) {
  const double tick = 1.0 / (rates.gesturalHz() * scene.time_unit_s);
  const double newton = 1.0 / (scene.time_unit_s * scene.time_unit_s);
  const Network network(scene);
  const PortLinks links(network);
  std::vector<NoiseFloor> floors;
  for (int p = 0; p < static_cast<int>(scene.ports.size()); ++p) {
    const scene::Port& port = scene.ports[at(p)];
    if (port.agent >= 0) {
      continue;
    }
    const double at_device = newton * noise.total() * port.force_scale / port.position_scale;
    NoiseFloor floor;
    floor.port = p;
    floor.position = floor.behind = noise.total();
    floor.force = floor.unfiltered = at_device * forceOf(links.atSlice(port), tick);
    if (port.filter >= 0) {
      const scene::Mat& mass = scene.mats[at(port.filter)];
      Hanging hanging{links.atSlice(port), links.behindFilter(port), scene.valueOf(mass.mass)};
      hanging.steps = std::max(1, rates.ratio / divisorOf(scene.sectionOf(mass), rates));
      hanging.step = tick / hanging.steps;
      const Response response = responseOf(hanging);
      floor.force = at_device * response.force;
      floor.behind = noise.total() * response.behind;
      floor.unfiltered = at_device * forceOf(hanging.behind, tick);
    }
    floors.push_back(floor);
  }
  return floors;
}

}  // namespace ergotic::physics
