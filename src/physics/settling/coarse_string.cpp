// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/coarse_string.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/scene/coarse_string.hpp"
#include "physics/note.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kSprings = 3;

double squaredSine(double angle) {
  return 4.0 * std::pow(std::sin(angle / 2.0), 2);
}

/// What the spring to the k-th neighbour does to mode j of N masses.
double shareOf(int spring, int mode, int masses) {
  return squaredSine(spring * mode * kPi / (masses + 1));
}

[[noreturn]] void fail(const scene::Scene& scene,
                       const scene::StringInfo& string,
                       const std::string& what) {
  const scene::Place place = scene.mats[at(string.first)].place;
  throw TextError(scene.file, place.line, place.column, "string '" + string.name + "' " + what);
}

void requireStability(const scene::Scene& scene,
                      const scene::StringInfo& string,
                      const CoarseFit& fit) {
  const int masses = string.count - 2;
  for (int mode = 1; mode <= masses; ++mode) {
    const double lambda = coarseEigenvalue(fit, masses, mode);
    if (!(lambda > 0.0 && lambda < 4.0)) {
      fail(scene, string,
           "cannot be tuned to " + shortly(string.corrected_hz) + " Hz with " +
               std::to_string(masses) + " masses: mode " + std::to_string(mode) +
               " would have the eigenvalue " + shortly(lambda) +
               ", allowed 0...4. Use fewer masses or a lower frequency");
    }
  }
}

std::string noteOn(const scene::Scene& scene,
                   const scene::StringInfo& string,
                   const CoarseFit& fit) {
  const int partials = static_cast<int>(fit.cents.size());
  std::string text = noteAt(scene, scene.mats[at(string.first)].place) + "string '" + string.name +
                     "' is tuned to the partials of an ideal string of " +
                     shortly(string.corrected_hz) + " Hz with springs to three neighbours, error ";
  for (const int count : {1, (partials + 1) / 2, partials}) {
    text += (count == 1 ? "" : ", ") + shortly(fit.worstCents(count)) + " cents on " +
            std::to_string(count);
  }
  return text + " partials";
}

void setSprings(scene::Scene& scene, scene::StringInfo& string, const CoarseFit& fit, double step) {
  const int masses = string.count - 2;
  const double unit = 1.0 / (step * step);
  for (int i = 0; i < scene::coarseLinks(masses); ++i) {
    const double kappa = scene::coarseLink(masses, i).stiffness(fit.kappa);
    scene.lias[at(string.first_lia + i)].stiffness = kappa * unit * string.mass;
  }
  // One spring with the same fundamental: what the string's closed-form pitch is computed from.
  const double plain = coarseEigenvalue(fit, masses, 1) / shareOf(1, 1, masses);
  string.stiffness = plain * unit * string.mass;
  string.corrected_hz = 0.0;
}

}  // namespace

int fittedPartials(int masses) {
  return std::max(kSprings, masses / 2);
}

double CoarseFit::worstCents(int partials) const {
  double worst = 0.0;
  for (int j = 0; j < partials; ++j) {
    worst = std::max(worst, std::abs(cents[at(j)]));
  }
  return worst;
}

double coarseEigenvalue(const CoarseFit& fit, int masses, int mode) {
  double lambda = 0.0;
  for (int k = 0; k < kSprings; ++k) {
    lambda += fit.kappa[at(k)] * shareOf(k + 1, mode, masses);
  }
  return lambda;
}

CoarseFit fitCoarseString(int masses, double frequency, int partials) {
  Eigen::MatrixXd shares(partials, kSprings);
  for (int j = 0; j < partials; ++j) {
    const double wanted = squaredSine(2.0 * kPi * frequency * (j + 1));
    for (int k = 0; k < kSprings; ++k) {
      shares(j, k) = shareOf(k + 1, j + 1, masses) / wanted;
    }
  }
  const Eigen::Vector3d kappa = shares.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(partials));
  CoarseFit fit;
  fit.kappa = {kappa[0], kappa[1], kappa[2]};
  for (int j = 1; j <= partials; ++j) {
    const double half = std::sqrt(coarseEigenvalue(fit, masses, j)) / 2.0;
    fit.cents.push_back(1200.0 * std::log2(std::asin(half) / (kPi * frequency * j)));
  }
  return fit;
}

void fitCoarseStrings(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  for (scene::StringInfo& string : scene.strings) {
    if (!(string.corrected_hz > 0.0)) {
      continue;
    }
    const int masses = string.count - 2;
    const int divisor = divisorOf(scene.sectionOf(scene.mats[at(string.first)]), rates);
    const double frequency = string.corrected_hz * divisor / rates.audio_hz;
    const int partials = fittedPartials(masses);
    if (masses < scene::kFewestCoarseMasses) {
      fail(scene, string,
           "is coarse with " + std::to_string(masses) + " masses, allowed " +
               std::to_string(scene::kFewestCoarseMasses) + " or more");
    }
    if (!(partials * frequency < 0.5)) {
      fail(scene, string,
           "has " + std::to_string(partials) + " partials of " + shortly(string.corrected_hz) +
               " Hz to fit, allowed below half its rate, " +
               shortly(0.5 * rates.audio_hz / divisor) + " Hz");
    }
    const CoarseFit fit = fitCoarseString(masses, frequency, partials);
    requireStability(scene, string, fit);
    notes.push_back(noteOn(scene, string, fit));
    setSprings(scene, string, fit, StepUnits(scene, rates, divisor).step);
  }
}

}  // namespace ergotic::physics
