// SPDX-License-Identifier: BSD-3-Clause
#include "physics/laws/oscillator.hpp"

#include <cmath>

namespace ergotic::physics {

OscillatorCoefficients oscillatorOf(
    double stiffness, double damping, double mass, double step, bool matched) noexcept {
  if (!matched) {
    const double inverse = step * step / mass;
    return {damping / step * inverse, stiffness * inverse};
  }
  const double decay = 0.5 * damping / mass * step;  // s h
  const double turn = stiffness / mass * step * step - decay * decay;
  const double once = std::exp(-decay);
  // 2 - lose - 2 once cos = (1 - once)^2 + 2 once (1 - cos), without the cancellation.
  const double half = std::sqrt(std::abs(turn)) / 2.0;
  const double rest = turn >= 0.0 ? 2.0 * std::sin(half) * std::sin(half)
                                  : -2.0 * std::sinh(half) * std::sinh(half);
  const double lost = -std::expm1(-decay);
  return {-std::expm1(-2.0 * decay), stiffness == 0.0 ? 0.0 : lost * lost + 2.0 * once * rest};
}

OscillatorCoefficients oscillatorOf(const scene::Scene& scene,
                                    const scene::Mat& mat,
                                    const StepUnits& units) noexcept {
  const double medium = scene.valueOf(scene.sectionOf(mat).medium);
  const double mass = scene.valueOf(mat.mass);
  if (mat.type == scene::MatType::kCell) {
    return oscillatorOf(scene.valueOf(mat.stiffness), scene.valueOf(mat.damping) + medium, mass,
                        units.step, mat.matched);
  }
  return oscillatorOf(0.0, medium, mass, units.step, true);
}

}  // namespace ergotic::physics
