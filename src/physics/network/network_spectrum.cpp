// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/network_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "at.hpp"
#include "constants.hpp"
#include "physics/network/network_analysis.hpp"
#include "physics/network/network_matrix.hpp"

namespace ergotic::physics {
namespace {

constexpr double kPrecision = 2e-7;      // of a step; lambda goes with its square
constexpr int kSpectrumIterations = 20;  // of Collatz-Wielandt
constexpr int kRounds = 100;
constexpr int kInverseIterations = 4;

double quadratic(const Matrix& lower, const Eigen::VectorXd& x) {
  return x.dot(lower.selfadjointView<Eigen::Lower>() * x);
}

/// A direction that no mode is orthogonal to; the same at every run.
Eigen::VectorXd anyDirection(int count) {
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::VectorXd direction(count);
  for (double& each : direction) {
    each = number(random);
  }
  return direction;
}

}  // namespace

NetworkSpectrum::NetworkSpectrum(const NetworkBound& network)
    : network_(network), scale_(scaleOf(network)), mode_(anyDirection(network.nodes())) {
  pencil_.limit = NetworkBound::kLimit * (1.0 - kPivotMargin);
  pencil_.stiffness = assemble(
      network, scale_, [](const NetworkBound::Link& link) { return link.stiffness.highest; });
  pencil_.damping = assemble(network, scale_,
                             [](const NetworkBound::Link& link) { return link.damping.highest; });
  for (const NetworkBound::MovingLink& link : network.movingLinks()) {
    pencil_.moving_stiffness.push_back(link.stiffness);
    pencil_.moving_damping.push_back(link.damping);
  }
  const NetworkBound everywhere = network.withMovingEverywhere();
  bound_ = std::min(everywhere.linkBound(), everywhere.collatzWielandtBound(kSpectrumIterations));
  finite_ = physics::isFinite(pencil_.stiffness) && physics::isFinite(pencil_.damping) &&
            std::isfinite(bound_);
  if (finite_) {
    solver_.analyzePattern(pencil_.stiffness);
  }
}

bool NetworkSpectrum::isDefinite(const Pencil& pencil, double t) {
  Matrix matrix = pencil.stiffness;
  const double* z = pencil.damping.valuePtr();
  double* values = matrix.valuePtr();
  for (Eigen::Index i = 0; i < matrix.nonZeros(); ++i) {
    values[i] = -t * (t * values[i] + 2.0 * z[i]);
  }
  for (int i = 0; i < matrix.rows(); ++i) {
    values[matrix.outerIndexPtr()[i]] += pencil.limit;  // the first of its column
  }
  solver_.factorize(matrix);
  return allPivotsPositive(solver_);
}

/// max over the places of u^T P^-1 u.
double NetworkSpectrum::placeCompliance(const NetworkBound::MovingLink& link) const {
  double largest = 0.0;
  Eigen::VectorXd u(network_.nodes());
  for (const Shares& place : link.places) {
    u.setZero();
    for (const Share& share : place) {
      u[share.node] += share.weight * scale_[share.node];
    }
    largest = std::max(largest, u.dot(solver_.solve(u)));
  }
  return largest;
}

/// P - sum a u u^T is definite if P is and sum a u^T P^-1 u < 1; with one link: only if, too.
bool NetworkSpectrum::holds(const Pencil& pencil, double t) {
  if (!isDefinite(pencil, t)) {
    return false;
  }
  double taken = 0.0;
  for (std::size_t l = 0; l < network_.movingLinks().size(); ++l) {
    const double load = t * (t * pencil.moving_stiffness[l] + 2.0 * pencil.moving_damping[l]);
    taken += load > 0.0 ? load * placeCompliance(network_.movingLinks()[l]) : 0.0;
  }
  return taken < 1.0;
}

double NetworkSpectrum::reach(const Pencil& pencil) const {
  const double norm = mode_.squaredNorm();
  const double k = quadratic(pencil.stiffness, mode_) / norm;
  const double z = quadratic(pencil.damping, mode_) / norm;
  const double root = z * z + pencil.limit * k;
  const double below = z + std::sqrt(std::max(root, 0.0));
  return root >= 0.0 && below > 0.0 ? pencil.limit / below : kInfinity;
}

/// Finds the longest stable step from below by factorisation, from above by Rayleigh quotients;
/// inverse iteration turns the mode towards the one that is first to fail.
double NetworkSpectrum::longestAtRest(const Pencil& pencil, double proven) {
  double refuted = kInfinity;
  double part = 0.1;  // of what is undecided, from above
  bool is_factorised = false;
  for (int round = 0; round < kRounds; ++round) {
    if (!is_factorised && !isDefinite(pencil, proven)) {
      return 0.0;
    }
    for (int i = 0; i < kInverseIterations; ++i) {
      mode_ = solver_.solve(mode_).normalized();
      refuted = std::min(refuted, reach(pencil));
    }
    if (refuted - proven <= kPrecision * refuted) {
      break;
    }
    const double t = std::isfinite(refuted) ? refuted - part * (refuted - proven) : 2.0 * proven;
    is_factorised = isDefinite(pencil, t);
    (is_factorised ? proven : refuted) = t;
    part = is_factorised ? 0.1 : 0.5;
  }
  return proven;
}

double NetworkSpectrum::longest(const Pencil& pencil, double proven) {
  double highest = longestAtRest(pencil, proven);
  if (network_.movingLinks().empty() || holds(pencil, highest)) {
    return highest;
  }
  double lowest = std::min(proven, highest);
  while (highest - lowest > kPrecision * highest) {
    const double middle = 0.5 * (lowest + highest);
    (holds(pencil, middle) ? lowest : highest) = middle;
  }
  return lowest;
}

double NetworkSpectrum::lambda() {
  const double h = network_.step();
  Pencil here = pencil_;
  here.stiffness = h * h * pencil_.stiffness + 2.0 * h * pencil_.damping;
  here.damping = 0.0 * pencil_.damping;
  here.limit = 1.0;
  for (std::size_t l = 0; l < here.moving_stiffness.size(); ++l) {
    here.moving_stiffness[l] =
        h * h * pencil_.moving_stiffness[l] + 2.0 * h * pencil_.moving_damping[l];
    here.moving_damping[l] = 0.0;
  }
  if (!(bound_ > 0.0)) {
    return 0.0;
  }
  const double proven = (1.0 - kPivotMargin) / std::sqrt(bound_);
  const double t = longest(here, proven);
  lambda_ = std::min(bound_, 1.0 / (t * t));
  if (lambda_ >= pencil_.limit) {
    const bool is_below = holds(here, 1.0 / std::sqrt(pencil_.limit));
    lambda_ = is_below ? pencil_.limit : std::max(lambda_, NetworkBound::kLimit);
  }
  findWorst();
  return lambda_;
}

void NetworkSpectrum::findWorst() {
  const double h = network_.step();
  double largest = 0.0;
  for (const NetworkBound::Link& link : network_.links()) {
    double strain = 0.0;
    for (const Share& share : link.ends) {
      strain += share.weight * scale_[share.node] * mode_[share.node];
    }
    const double energy =
        (h * h * link.stiffness.highest + 2.0 * h * link.damping.highest) * strain * strain;
    if (energy > largest) {
      largest = energy;
      worst_link_ = link.label;
      const auto most =
          std::max_element(link.ends.begin(), link.ends.end(), [&](const Share& a, const Share& b) {
            return std::abs(mode_[a.node]) < std::abs(mode_[b.node]);
          });
      worst_owner_ = network_.ownerOf(most->node);
    }
  }
}

double NetworkSpectrum::longestStep() {
  if (!(bound_ > 0.0)) {
    return kInfinity;
  }
  // lambda grows at least as h and at most as h^2.
  const double h = network_.step();
  const double stretch = pencil_.limit / lambda_;
  const double proven = h * std::min(stretch, std::sqrt(stretch)) * (1.0 - kPivotMargin);
  return longest(pencil_, std::max(proven, network_.withMovingEverywhere().stableStep() *
                                               (1.0 - kPivotMargin)));
}

}  // namespace ergotic::physics
