// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "at.hpp"
#include "physics/certificate/port_links.hpp"
#include "physics/interpolation.hpp"

namespace ergotic::physics {
namespace {

/// A slice that moves by itself in each tick, the mass that is attached to it, and what holds that.
struct Attached {
  PortLinks::Resistance link;
  PortLinks::Resistance behind;
  double mass = 0.0;
  double step = 0.0;  // of the mass
  int steps = 1;      // in a tick
  bool interpolated = false;
};

/// Response to white positions of rms 1.
struct Response {
  double force = std::numeric_limits<double>::infinity();   // on the slice, rms
  double behind = std::numeric_limits<double>::infinity();  // of the mass, rms
};

/// How the mass sees the slice in a step, and what the slice gets of the force.
struct Sight {
  InterpolationStep seen;
  double now = 0.0;  // of its force, in this tick
};

std::vector<Sight> sightsOf(const Attached& attached) {
  std::vector<Sight> sights;
  if (attached.interpolated) {
    for (const InterpolationStep& step : interpolationSteps(attached.steps)) {
      sights.push_back({step, step.share_last});
    }
    return sights;
  }
  for (int k = 0; k < attached.steps; ++k) {
    sights.push_back({{0.0, 0.0, k == 0 ? 1.0 : 0.0, 0.0}, 1.0 / attached.steps});
  }
  return sights;
}

/// Computes that response. One tick is linear in the mass's position, step and force, the last two
/// positions, the last force of the link and what of it the slice has yet to get, and the present
/// position; the covariance of these reproduces itself (a Lyapunov equation, by doubling).
Response responseOf(const Attached& attached) {
  using Row = Eigen::Matrix<double, 1, 8>;
  constexpr int kDoublings = 60;
  Row y = Row::Unit(0);
  Row d = Row::Unit(1);
  Row f = Row::Unit(2);
  Row last = Row::Unit(5);
  const Row change = Row::Unit(7) - Row::Unit(3);
  const Row change_last = Row::Unit(3) - Row::Unit(4);
  Row force = Row::Unit(6);
  Row next = Row::Zero();
  for (const auto& [seen, now] : sightsOf(attached)) {
    d += attached.step * attached.step / attached.mass * f;
    y += d;
    const Row slice = Row::Unit(7) - seen.behind * change - seen.behind_last * change_last;
    const Row moved = seen.share * change + seen.share_last * change_last - d;
    const Row pull =
        attached.link.stiffness * (slice - y) + attached.link.damping / attached.step * moved;
    f = pull - attached.behind.stiffness * y - attached.behind.damping / attached.step * d;
    const Row mean = attached.interpolated ? Row(0.5 * (last + pull)) : pull;
    force -= now * mean;
    next -= (attached.interpolated ? seen.share : 0.0) * mean;
    last = pull;
  }
  Eigen::Matrix<double, 7, 8> tick;
  tick << y, d, f, Row::Unit(7), Row::Unit(3), last, next;
  Eigen::Matrix<double, 7, 7> map = tick.leftCols<7>();
  Eigen::Matrix<double, 7, 7> covariance = tick.col(7) * tick.col(7).transpose();
  for (int n = 0; n < kDoublings && map.allFinite(); ++n) {
    covariance += (map * covariance * map.transpose()).eval();
    map = (map * map).eval();
  }
  if (!map.isZero(1e-9)) {
    return {};
  }
  const Eigen::Matrix<double, 1, 7> by_state = force.leftCols<7>();
  return {std::sqrt(by_state * covariance * by_state.transpose() + force[7] * force[7]),
          std::sqrt(covariance(0, 0))};
}

/// Rms force without a filter: F[n] = (K + Z/T) x[n] - Z/T x[n-1], where it is not interpolated.
double forceOf(const PortLinks::Resistance& held,
               const PortLinks::Resistance& interpolated,
               int steps,
               double tick) {
  const InterpolationResponse answer = interpolationResponse(steps);
  double square = 0.0;
  for (std::size_t i = 0; i < answer.spring.size(); ++i) {
    double response =
        interpolated.stiffness * answer.spring[i] + interpolated.damping / tick * answer.damper[i];
    response += i == 0 ? held.stiffness + held.damping / tick : i == 1 ? -held.damping / tick : 0.0;
    square += response * response;
  }
  return std::sqrt(square);
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
  const PortLinks links(network, rates);
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
    const int frames = std::max(2, rates.ratio);
    floor.force = floor.unfiltered =
        at_device * forceOf(links.heldAtSlice(port), links.interpolatedAtSlice(port), frames, tick);
    if (port.filter >= 0) {
      const scene::Mat& mass = scene.mats[at(port.filter)];
      Attached attached{links.atSlice(port), links.behindFilter(port), scene.valueOf(mass.mass)};
      attached.steps = std::max(1, rates.ratio / divisorOf(scene.sectionOf(mass), rates));
      attached.step = tick / attached.steps;
      attached.interpolated = isInterpolated(scene, rates, port.mat, mass.section);
      const Response response = responseOf(attached);
      floor.force = at_device * response.force;
      floor.behind = noise.total() * response.behind;
      floor.unfiltered =
          at_device * (attached.interpolated ? forceOf({}, attached.behind, frames, tick)
                                             : forceOf(attached.behind, {}, frames, tick));
    }
    floors.push_back(floor);
  }
  return floors;
}

}  // namespace ergotic::physics
