// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/network_analysis.hpp"

#include <algorithm>
#include <cmath>

#include "physics/network/cell_bound.hpp"
#include "physics/network/network_spectrum.hpp"

namespace ergotic::physics {
namespace {

constexpr int kIterations = 20;  // of Collatz-Wielandt
constexpr int kPowerIterations = 60;
constexpr double kRounding = 1e-9;
constexpr int kCheapNodes = 20000;         // factorised even if the bounds suffice
constexpr int kLargestComponent = 200000;  // factorised at all
constexpr double kMaxSolutions = 2e6;      // places of moving links times nodes

bool areMovingLinksCheap(const NetworkBound& network) {
  double places = 0.0;
  for (const NetworkBound::MovingLink& link : network.movingLinks()) {
    places += static_cast<double>(link.places.size());
  }
  return places * network.nodes() <= kMaxSolutions;
}

/// The longest step that a bound at this one allows: the eigenvalue grows at least as h and at most
/// as h^2.
double stretched(double step, double lambda) {
  const double stretch = NetworkBound::kLimit * (1.0 - kRounding) / lambda;
  return step * std::min(stretch, std::sqrt(stretch));
}

void bound(const NetworkBound& network, NetworkAnalysis& to) {
  to.link_bound = network.linkBound();
  to.lambda = to.link_bound;
  to.worst_link = network.worstLink();
  to.worst_owner = network.worstOwner();
  to.stable_step = network.stableStep();
  if (to.isProven()) {
    return;
  }
  to.lambda = std::min(to.lambda, cellBound(network));
  if (!to.isProven()) {
    to.lambda = std::min(to.lambda, network.collatzWielandtBound(kIterations));
  }
  to.stable_step = std::max(to.stable_step, stretched(network.step(), to.lambda));
}

/// True if it is above the limit for certain.
bool isRefuted(const NetworkBound& network) {
  return rayleighQuotient(network, kPowerIterations) >= NetworkBound::kLimit * (1.0 + kRounding);
}

void refine(const NetworkBound& network, NetworkAnalysis& to) {
  NetworkSpectrum spectrum(network);
  if (!spectrum.isFinite()) {
    return;
  }
  to.lambda = std::min(to.lambda, spectrum.lambda());
  to.stable_step = std::max(to.stable_step, spectrum.longestStep());
  to.is_bound = network.movingLinks().size() > 1;
  to.is_exact = !to.is_bound;
  if (spectrum.worstLink() >= 0 || spectrum.worstOwner() >= 0) {
    to.worst_link = spectrum.worstLink();
    to.worst_owner = spectrum.worstOwner();
  }
}

}  // namespace

NetworkAnalysis analyse(const NetworkBound& network) {
  if (!areMovingLinksCheap(network)) {
    NetworkAnalysis result = analyse(network.withMovingEverywhere());
    result.is_exact = false;
    result.is_bound = true;
    return result;
  }
  NetworkAnalysis result;
  if (network.movingLinks().empty()) {
    bound(network, result);
  } else {
    bound(network.withMovingEverywhere(), result);
  }
  const bool is_cheap = network.nodes() <= kCheapNodes;
  const bool is_decided = result.isProven() || (!is_cheap && isRefuted(network));
  if (is_cheap || !is_decided) {
    result.is_too_large = !is_cheap && network.largestComponent() > kLargestComponent;
    if (!result.is_too_large) {
      refine(network, result);
    }
  }
  return result;
}

std::optional<std::vector<int>> semidefiniteBesideNegative(const NetworkBound& network) {
  std::optional<std::vector<int>> modules = std::vector<int>();
  if (network.hasNegativeStiffness()) {
    modules = NetworkSpectrum::semidefiniteStiffness(network);
  }
  if (modules && network.hasNegativeDamping()) {
    const auto more = NetworkSpectrum::semidefiniteDamping(network);
    if (!more) {
      return std::nullopt;
    }
    modules->insert(modules->end(), more->begin(), more->end());
  }
  return modules;
}

bool losesInEveryMotion(const NetworkBound& network) {
  return NetworkSpectrum::hasDefiniteDamping(network);
}

}  // namespace ergotic::physics
