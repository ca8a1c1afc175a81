// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/generate/pitch.hpp"

#include <cmath>
#include <limits>

namespace ergotic::scene {
namespace {

/// Share of a velocity that the ground takes in a step: zeta of one mass, by its loss and by the
/// medium.
double groundLoss(const Scene& scene, const StringInfo& string, double step) {
  const Mat& mat = scene.mats[static_cast<std::size_t>(string.first + 1)];
  const double damping = scene.valueOf(string.loss) + scene.valueOf(scene.sectionOf(mat).medium);
  const double zeta = damping * step / scene.valueOf(string.mass);
  const bool first_order = mat.type == MatType::kCell && !mat.matched;
  return first_order ? zeta : -std::expm1(-zeta);
}

/// What the tension leaves of a link's stiffness across the string.
double transverseShare(const Scene& scene, const StringInfo& string) {
  const Lia& link = scene.lias[static_cast<std::size_t>(string.first_lia)];
  const Mat& first = scene.mats[static_cast<std::size_t>(string.first)];
  const Mat& second = scene.mats[static_cast<std::size_t>(string.first + 1)];
  const int moving = dimensionsOf(scene.sectionOf(first).geometry);
  return 1.0 - link.rest_length / (second.rest - first.rest).head(moving).norm();
}

}  // namespace

double stringKappa(const Scene& scene, const StringInfo& string, double rate_hz) {
  const double h = 1.0 / (rate_hz * scene.time_unit_s);  // in the scene's time unit
  return scene.valueOf(string.stiffness) * h * h / scene.valueOf(string.mass);
}

bool holdsPitch(const Scene& scene, const StringInfo& string, double rate_hz) {
  constexpr double kStiffest = 0.25;  // both masses and both neighbours count
  const Lia& link = scene.lias[static_cast<std::size_t>(string.first_lia)];
  return link.scheme != Scheme::kGuarded || stringKappa(scene, string, rate_hz) <= kStiffest;
}

double stringPitchHz(const Scene& scene, const StringInfo& string, double rate_hz) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (string.corrected_hz > 0.0 || !holdsPitch(scene, string, rate_hz)) {
    return kNone;
  }
  const double h = 1.0 / (rate_hz * scene.time_unit_s);  // in the scene's time unit
  const double half = std::sin(M_PI / (2.0 * (string.count - 1)));
  const double s = 4.0 * half * half;
  const double mass = scene.valueOf(string.mass);
  double kappa = s * stringKappa(scene, string, rate_hz);
  double zeta = groundLoss(scene, string, h);
  const Mat& first = scene.mats[static_cast<std::size_t>(string.first)];
  if (dimensionsOf(scene.sectionOf(first).geometry) == 1) {
    zeta += s * scene.valueOf(string.damping) * h / mass;
  } else {
    kappa *= transverseShare(scene, string);
  }
  const double real = 0.5 * (2.0 - kappa - zeta);
  // (1 - zeta) - real^2, without the cancellation that a low mode would suffer
  const double imaginary_squared = kappa - 0.25 * (kappa + zeta) * (kappa + zeta);
  if (!(imaginary_squared > 0.0)) {
    return kNone;
  }
  return std::atan2(std::sqrt(imaginary_squared), real) / (2.0 * M_PI) * rate_hz;
}

}  // namespace ergotic::scene
