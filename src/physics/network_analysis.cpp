// SPDX-License-Identifier: BSD-3-Clause
#include "network_analysis.hpp"

#include <algorithm>
#include <cmath>

#include "network_spectrum.hpp"

namespace ergotic::physics {
namespace {

constexpr int kIterations = 20;            // of Collatz-Wielandt
constexpr int kCheapNodes = 20000;         // factorised even if the bounds suffice
constexpr int kLargestComponent = 200000;  // factorised at all
constexpr double kMostSolutions = 2e6;     // places of moving links times nodes

bool areMovingLinksCheap(const NetworkBound& network) {
  double places = 0.0;
  for (const NetworkBound::MovingLink& link : network.movingLinks()) {
    places += static_cast<double>(link.places.size());
  }
  return places * network.nodes() <= kMostSolutions;
}

void bound(const NetworkBound& network, NetworkAnalysis& to) {
  to.link_bound = network.linkBound();
  to.lambda = to.link_bound;
  if (!to.isProven()) {
    to.lambda = std::min(to.lambda, network.collatzWielandtBound(kIterations));
  }
  to.worst_link = network.worstLink();
  to.worst_owner = network.worstOwner();
  to.stable_step = network.stableStep();
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
  bound(network.withMovingEverywhere(), result);
  const bool is_cheap = network.nodes() <= kCheapNodes;
  if (is_cheap || !result.isProven()) {
    result.is_too_large = !is_cheap && network.largestComponent() > kLargestComponent;
    if (!result.is_too_large) {
      refine(network, result);
    }
  }
  return result;
}

bool isSemidefinite(const NetworkBound& network) {
  return (!network.hasNegativeStiffness() || NetworkSpectrum::isStiffnessSemidefinite(network)) &&
         (!network.hasNegativeDamping() || NetworkSpectrum::isDampingSemidefinite(network));
}

}  // namespace ergotic::physics
