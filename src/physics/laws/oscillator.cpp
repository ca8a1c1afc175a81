// SPDX-License-Identifier: BSD-3-Clause
#include "physics/laws/oscillator.hpp"

#include <cmath>

namespace ergotic::physics {
namespace {

/// Underdamped, r = e^-decay: 1 - 2 r cos(w) + r^2 = (1 - r)^2 + 2 r (1 - cos(w)), without
/// cancellation. \param turn  w^2
double underdampedPull(double decay, double turn) noexcept {
  const double half = std::sin(std::sqrt(turn) / 2.0);
  const double lost = -std::expm1(-decay);
  return lost * lost + 2.0 * std::exp(-decay) * (2.0 * half * half);
}

/// Overdamped: (1 - p)(1 - q) of the real poles p = e^(-kappa/fast), q = e^(-fast). By a cosh it
/// would overflow for a cell that fades within a step.
double overdampedPull(double decay, double kappa) noexcept {
  const double fast = decay + std::sqrt(decay * decay - kappa);
  return std::expm1(-kappa / fast) * std::expm1(-fast);
}

}  // namespace

OscillatorCoefficients oscillatorOf(
    double stiffness, double damping, double mass, double step, bool matched) noexcept {
  if (!matched) {
    const double inverse = step * step / mass;
    return {damping / step * inverse, stiffness * inverse};
  }
  const double decay = 0.5 * damping / mass * step;  // s h
  const double kappa = stiffness / mass * step * step;
  const double turn = kappa - decay * decay;
  return {-std::expm1(-2.0 * decay), stiffness == 0.0 ? 0.0
                                     : turn >= 0.0    ? underdampedPull(decay, turn)
                                                      : overdampedPull(decay, kappa)};
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
