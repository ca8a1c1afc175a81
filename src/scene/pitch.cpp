// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/pitch.hpp"

#include <cmath>
#include <limits>

namespace ergotic::scene {

double stringPitchHz(const Scene& scene, const StringInfo& string, double rate_hz) {
  const double h = 1.0 / (rate_hz * scene.time_unit_s);  // in the scene's time unit
  const double half = std::sin(M_PI / (2.0 * (string.count - 1)));
  const double s = 4.0 * half * half;
  const double mass = scene.valueOf(string.mass);
  const double kappa = s * scene.valueOf(string.stiffness) * h * h / mass;
  const double zeta = (s * scene.valueOf(string.damping) + scene.valueOf(string.loss)) * h / mass;
  const double real = 0.5 * (2.0 - kappa - zeta);
  // (1 - zeta) - real^2, without the cancellation that a low mode would suffer
  const double imaginary_squared = kappa - 0.25 * (kappa + zeta) * (kappa + zeta);
  if (!(imaginary_squared > 0.0)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::atan2(std::sqrt(imaginary_squared), real) / (2.0 * M_PI) * rate_hz;
}

}  // namespace ergotic::scene
