// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/noise.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "port_links.hpp"

namespace ergotic::physics {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// A numerator, powers of 1/z.
using Taps = std::array<double, 4>;

/// White noise of rms 1 through b(1/z)/(1 + a1/z + a2/z^2): the rms of what comes out.
double rmsThrough(const Taps& b, double a1, double a2) {
  if (!(std::abs(a2) < 1.0 && std::abs(a1) < 1.0 + a2)) {
    return std::numeric_limits<double>::infinity();
  }
  Taps lags{};  // autocorrelation of 1/(1 + a1/z + a2/z^2)
  lags[0] = (1.0 + a2) / ((1.0 - a2) * ((1.0 + a2) * (1.0 + a2) - a1 * a1));
  lags[1] = -a1 / (1.0 + a2) * lags[0];
  for (std::size_t n = 2; n < lags.size(); ++n) {
    lags[n] = -a1 * lags[n - 1] - a2 * lags[n - 2];
  }
  double power = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      power += b[i] * b[k] * lags[i < k ? k - i : i - k];
    }
  }
  return std::sqrt(power);
}

/// Force of a link on a step: `now` times this position less `before` times the last.
struct Difference {
  Difference(const PortLinks::Resistance& link, double tick)
      : now(link.stiffness + link.damping / tick), before(link.damping / tick) {}
  double now;
  double before;
};

}  // namespace

double SensorNoise::total() const {
  return std::sqrt(rms * rms + quantum * quantum / 12.0);
}

std::vector<NoiseFloor> noiseFloors(const scene::Scene& scene,
                                    const Rates& rates,
                                    const SensorNoise& noise) {
  const double tick = 1.0 / (rates.gesturalHz() * scene.time_unit_s);
  const double newton = 1.0 / (scene.time_unit_s * scene.time_unit_s);
  const PortLinks links(scene);
  std::vector<NoiseFloor> floors;
  for (int p = 0; p < static_cast<int>(scene.ports.size()); ++p) {
    const scene::Port& port = scene.ports[at(p)];
    if (port.agent >= 0) {
      continue;
    }
    const double at_device = newton * noise.total() * port.force_scale / port.position_scale;
    const Difference slice(links.atSlice(port), tick);
    NoiseFloor floor;
    floor.port = p;
    floor.position = floor.behind = noise.total();
    floor.force = floor.unfiltered = at_device * std::hypot(slice.now, slice.before);
    if (port.filter >= 0) {
      // T^2/m of its mass: y (1 + a1/z + a2/z^2) = g (slice.now/z - slice.before/z^2) x
      const double g = tick * tick / scene.valueOf(scene.mats[at(port.filter)].mass);
      const Difference behind(links.behindFilter(port), tick);
      const double a1 = g * (slice.now + behind.now) - 2.0;
      const double a2 = 1.0 - g * (slice.before + behind.before);
      const double b1 = g * slice.now;
      const double b2 = -g * slice.before;
      // (slice.now - slice.before/z) (y - x)
      const Taps stretch = {-1.0, b1 - a1, b2 - a2, 0.0};
      Taps force{};
      for (std::size_t n = 0; n < force.size(); ++n) {
        force[n] = slice.now * stretch[n] - (n > 0 ? slice.before * stretch[n - 1] : 0.0);
      }
      floor.behind = noise.total() * rmsThrough({0.0, b1, b2, 0.0}, a1, a2);
      floor.force = at_device * rmsThrough(force, a1, a2);
      floor.unfiltered = at_device * std::hypot(behind.now, behind.before);
    }
    floors.push_back(floor);
  }
  return floors;
}

}  // namespace ergotic::physics
