// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "constants.hpp"
#include "ergotic/scene/coarse_string.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "physics/interpolation.hpp"
#include "physics/settling/coarse_string.hpp"

namespace ergotic::physics {
namespace {

/// Measured: (steps, error), both ascending in the first.
using Measured = std::vector<std::pair<double, double>>;

/// A felt hammer on a string, by how many slow steps they touch: docs/speed-accuracy.csv.
const Measured kHeldBare{{10.6, 0.115},  {16.6, 0.061},   {33.3, 6.1e-3},
                         {66.6, 1.3e-3}, {116.5, 4.0e-4}, {233.0, 9.0e-5}};
const Measured kHeldFiltered{{10.6, 0.91}, {16.6, 0.87}, {33.3, 0.85}, {66.6, 0.60}, {116.5, 0.40}};

/// Straight lines between the logarithms, beyond the ends too.
double valueAt(const Measured& points, double x) {
  auto upper = std::lower_bound(points.begin() + 1, points.end() - 1, std::pair(x, 0.0));
  const auto lower = upper - 1;
  const double slope =
      std::log(upper->second / lower->second) / std::log(upper->first / lower->first);
  return lower->second * std::pow(x / lower->first, slope);
}

/// h^2 w^2 of every mode in continuous time; empty if that cannot be had.
std::vector<double> eigenvaluesOf(const scene::StringCut& cut, double pitch, bool is_tuned) {
  std::vector<double> values;
  if (cut.coarse) {
    const int fitted = fittedPartials(cut.masses);
    if (cut.masses < scene::kFewestCoarseMasses || fitted * pitch >= 0.5) {
      return values;
    }
    const CoarseFit fit = fitCoarseString(cut.masses, pitch, fitted);
    for (int mode = 1; mode <= cut.masses; ++mode) {
      values.push_back(coarseEigenvalue(fit, cut.masses, mode));
    }
    return values;
  }
  const double angle = 2.0 * kPi * pitch;
  const double lowest = is_tuned ? scene::modeKappa(angle, 0.0) : angle * angle;
  const double link = lowest / scene::stringEigenvalue(cut.masses, 1);
  for (int mode = 1; mode <= cut.masses; ++mode) {
    values.push_back(link * scene::stringEigenvalue(cut.masses, mode));
  }
  return values;
}

}  // namespace

std::vector<double> partialsOf(const scene::StringCut& cut, double pitch, bool is_tuned) {
  std::vector<double> partials(kJudgedPartials, std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> values = eigenvaluesOf(cut, pitch, is_tuned);
  const auto holds = [](double value) { return value > 0.0 && value < 4.0; };
  if (std::all_of(values.begin(), values.end(), holds)) {
    const std::size_t count = std::min(partials.size(), values.size());
    std::transform(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count),
                   partials.begin(),
                   [](double value) { return std::asin(std::sqrt(value) / 2.0) / kPi; });
  }
  return partials;
}

double stringError(const scene::StringCut& cut, double pitch, bool is_tuned) {
  double worst = 0.0;
  double ideal = 0.0;
  for (const double partial : partialsOf(cut, pitch, is_tuned)) {
    ideal += pitch;
    const double error = std::abs(partial / ideal - 1.0);
    worst = error >= worst ? error : std::isnan(error) ? kInfinity : worst;
  }
  return worst;
}

double modeError(double angle) {
  return angle < 2.0 ? 2.0 * std::asin(angle / 2.0) / angle - 1.0 : kInfinity;
}

double contactDuration(double exponent, double stiffness, double mass, double depth) {
  const double share = 1.0 / (exponent + 1.0);
  const double integral = std::sqrt(kPi) * std::tgamma(1.0 + share) / std::tgamma(0.5 + share);
  const double speed =
      std::sqrt(2.0 * stiffness * std::pow(depth, exponent + 1.0) / ((exponent + 1.0) * mass));
  return 2.0 * integral * depth / speed;
}

double contactError(ContactFigure figure, scene::Scheme scheme, double exponent, double steps) {
  const double above = exponent - 1.0;
  const bool energy_stable = scheme == scene::Scheme::kEnergyStable;
  if (figure == ContactFigure::kPeakForce) {
    const double size = energy_stable ? 1.3 + 2.0 * above : 0.65 + 0.42 * above;
    return std::min(size / (steps * steps), 1.0);
  }
  return std::min(energy_stable ? 0.17 * std::exp(1.1 * above) / std::pow(steps, 4)
                                : (kPi * kPi / 24.0 + 0.19 * above) / (steps * steps),
                  1.0);
}

double heldContactError(bool filtered, double slow_steps) {
  return std::min(valueAt(filtered ? kHeldFiltered : kHeldBare, slow_steps), 1.0);
}

double handError(scene::Coupling coupling, double slow_steps) {
  return std::min(heardSteps(coupling, 1.0 / slow_steps), 1.0);
}

double bowError(scene::Scheme scheme, double steps) {
  return std::min((scheme == scene::Scheme::kEnergyStable ? 0.2 : 1.0) / steps, 1.0);
}

}  // namespace ergotic::physics
