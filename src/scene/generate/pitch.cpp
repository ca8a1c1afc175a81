// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/generate/pitch.hpp"

#include <cmath>
#include <limits>

#include "at.hpp"

namespace ergotic::scene {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Length of a step, in the scene's time unit.
double stepOf(const Scene& scene, double rate_hz) {
  return 1.0 / (rate_hz * scene.time_unit_s);
}

bool movesAlong(const Scene& scene, const StringInfo& string) {
  return dimensionsOf(scene.sectionOf(scene.mats[at(string.first)]).geometry) == 1;
}

/// zeta of one mass.
double groundLoss(const Scene& scene, const StringInfo& string, double step) {
  const Mat& mat = scene.mats[at(string.first + 1)];
  const double damping = scene.valueOf(string.loss) + scene.valueOf(scene.sectionOf(mat).medium);
  const double zeta = damping * step / scene.valueOf(string.mass);
  const bool first_order = mat.type == MatType::kCell && !mat.matched;
  return first_order ? zeta : -std::expm1(-zeta);
}

/// Part of a link's stiffness that the tension leaves across the string; 1 along it.
double tensionShare(const Scene& scene, const StringInfo& string) {
  return movesAlong(scene, string) ? 1.0 : 1.0 - string.rest_length_ratio;
}

}  // namespace

double modeAngle(double kappa, double zeta) {
  // (1 - zeta) - real^2, without the cancellation that a low mode would suffer
  const double imaginary_squared = kappa - 0.25 * (kappa + zeta) * (kappa + zeta);
  const double real = 0.5 * (2.0 - kappa - zeta);
  return imaginary_squared > 0.0 ? std::atan2(std::sqrt(imaginary_squared), real) : kNone;
}

double modeKappa(double angle, double zeta) {
  if (!(zeta < 1.0 && angle < M_PI)) {
    return kNone;
  }
  const double rho = std::sqrt(1.0 - zeta);
  const double lost = zeta / (1.0 + rho);  // 1 - rho
  const double half = std::sin(0.5 * angle);
  return lost * lost + 4.0 * rho * half * half;
}

double stringEigenvalue(int masses, int mode) {
  const double half = std::sin(mode * M_PI / (2.0 * (masses + 1)));
  return 4.0 * half * half;
}

StringLoss stringLoss(const Scene& scene, const StringInfo& string, double rate_hz) {
  return {groundLoss(scene, string, stepOf(scene, rate_hz)),
          movesAlong(scene, string) ? stringZeta(scene, string, rate_hz) : 0.0};
}

double stringKappa(const Scene& scene, const StringInfo& string, double rate_hz) {
  const double step = stepOf(scene, rate_hz);
  return scene.valueOf(string.stiffness) * step * step / scene.valueOf(string.mass);
}

double stringZeta(const Scene& scene, const StringInfo& string, double rate_hz) {
  return stepOf(scene, rate_hz) * scene.valueOf(string.damping) / scene.valueOf(string.mass);
}

bool holdsPitch(const Scene& scene, const StringInfo& string, double rate_hz) {
  const double energy_stable = string.rest_length_ratio * stringKappa(scene, string, rate_hz);
  return scene.lias[at(string.first_lia)].scheme == Scheme::kExplicit ||
         !movesAlong(scene, string) || energy_stable <= kStiffestInTune;
}

double stringPitchHz(const Scene& scene, const StringInfo& string, double rate_hz) {
  const bool is_open = string.coarse && string.frequency_hz > 0.0;
  if (is_open || !holdsPitch(scene, string, rate_hz)) {
    return kNone;
  }
  const int masses = string.count - 2;
  const double kappa = stringEigenvalue(masses, 1) * tensionShare(scene, string) *
                       stringKappa(scene, string, rate_hz);
  const double zeta = stringLoss(scene, string, rate_hz).ofMode(masses, 1);
  return modeAngle(kappa, zeta) / (2.0 * M_PI) * rate_hz;
}

Value tunedStiffness(const Scene& scene, const StringInfo& string, double rate_hz) {
  const int masses = string.count - 2;
  const double step = stepOf(scene, rate_hz);
  const double kappa = modeKappa(2.0 * M_PI * string.frequency_hz / rate_hz,
                                 stringLoss(scene, string, rate_hz).ofMode(masses, 1));
  const double one_link = stringEigenvalue(masses, 1) * tensionShare(scene, string);
  return kappa / (one_link * step * step) * string.mass;
}

}  // namespace ergotic::scene
