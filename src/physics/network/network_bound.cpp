// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/network_bound.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "at.hpp"
#include "constants.hpp"
#include "physics/disjoint_sets.hpp"

namespace ergotic::physics {
namespace {

double positive(const Range& span) {
  return std::max(span.highest, 0.0);
}

}  // namespace

int NetworkBound::addNode(double mass, int owner) {
  mass_.push_back(mass);
  owner_.push_back(owner);
  return nodes() - 1;
}

void NetworkBound::addLink(const Shares& ends, Range stiffness, Range damping, int label) {
  Link link{{}, stiffness, damping, label};
  for (const Share& share : ends) {
    const auto known = std::find_if(link.ends.begin(), link.ends.end(),
                                    [&](const Share& each) { return each.node == share.node; });
    if (known == link.ends.end()) {
      link.ends.push_back(share);
    } else {
      known->weight += share.weight;
    }
  }
  link.ends.erase(std::remove_if(link.ends.begin(), link.ends.end(),
                                 [](const Share& share) { return share.weight == 0.0; }),
                  link.ends.end());
  if (!link.ends.empty()) {
    links_.push_back(std::move(link));
  }
}

void NetworkBound::addMovingLink(const std::vector<Shares>& places,
                                 double stiffness,
                                 double damping,
                                 int label) {
  moving_.push_back({places, std::max(stiffness, 0.0), std::max(damping, 0.0), label});
}

NetworkBound NetworkBound::withMovingEverywhere() const {
  NetworkBound all = *this;
  all.moving_.clear();
  for (const MovingLink& link : moving_) {
    // Of the weights of one sign at a place, which add up to s, (w x)^2 <= s sum |w| x^2: a load on
    // each node by itself is the larger one.
    std::map<int, double> largest[2];
    double most[2] = {0.0, 0.0};
    for (const Shares& place : link.places) {
      double sum[2] = {0.0, 0.0};
      for (const Share& share : place) {
        const int side = share.weight < 0.0 ? 1 : 0;
        double& weight = largest[side][share.node];
        weight = std::max(weight, std::abs(share.weight));
        sum[side] += std::abs(share.weight);
      }
      most[0] = std::max(most[0], sum[0]);
      most[1] = std::max(most[1], sum[1]);
    }
    double ease[2] = {0.0, 0.0};  // largest load / mass of either sign
    for (const int side : {0, 1}) {
      for (auto& [node, weight] : largest[side]) {
        weight *= most[side];
        ease[side] = std::max(ease[side], weight / mass(node));
      }
    }
    for (const int side : {0, 1}) {
      const double both = ease[side] > 0.0 ? (ease[0] + ease[1]) / ease[side] : 1.0;
      for (const auto& [node, weight] : largest[side]) {
        const double k = both * weight * link.stiffness;
        const double z = both * weight * link.damping;
        all.addLink({{node, 1.0}}, {k, k}, {z, z}, link.label);
      }
    }
  }
  return all;
}

double NetworkBound::load(const Link& link) const {
  return step_ * step_ * positive(link.stiffness) + 2.0 * step_ * positive(link.damping);
}

std::vector<double> NetworkBound::sums(double per_stiffness, double per_damping) const {
  std::vector<double> sum(mass_.size(), 0.0);
  for (const Link& link : links_) {
    const double here =
        per_stiffness * positive(link.stiffness) + per_damping * positive(link.damping);
    for (const Share& share : link.ends) {
      sum[at(share.node)] += here * std::abs(share.weight);
    }
  }
  return sum;
}

double NetworkBound::bound(const Link& link, const std::vector<double>& sum) const {
  double total = 0.0;
  for (const Share& share : link.ends) {
    total += std::abs(share.weight) * sum[at(share.node)] / mass(share.node);
  }
  return load(link) > 0.0 ? (std::isnan(total) ? kInfinity : total) : 0.0;
}

const NetworkBound::Link* NetworkBound::worst() const {
  const std::vector<double> sum = sums(step_ * step_, 2.0 * step_);
  const Link* result = nullptr;
  double largest = 0.0;
  for (const Link& link : links_) {
    const double here = bound(link, sum);
    if (here > largest) {
      largest = here;
      result = &link;
    }
  }
  return result;
}

double NetworkBound::linkBound() const {
  const Link* link = worst();
  return link == nullptr ? 0.0 : bound(*link, sums(step_ * step_, 2.0 * step_));
}

int NetworkBound::worstLink() const {
  const Link* link = worst();
  return link == nullptr ? -1 : link->label;
}

int NetworkBound::worstOwner() const {
  const Link* link = worst();
  if (link == nullptr) {
    return -1;
  }
  const std::vector<double> sum = sums(step_ * step_, 2.0 * step_);
  const auto ratio = [&](const Share& share) { return sum[at(share.node)] / mass(share.node); };
  const auto most =
      std::max_element(link->ends.begin(), link->ends.end(),
                       [&](const Share& a, const Share& b) { return ratio(a) < ratio(b); });
  return ownerOf(most->node);
}

std::vector<int> NetworkBound::components() const {
  DisjointSets sets(mass_.size());
  for (const Link& link : links_) {
    if (load(link) > 0.0) {
      for (const Share& share : link.ends) {
        sets.join(share.node, link.ends.front().node);
      }
    }
  }
  std::vector<int> component(mass_.size());
  for (int node = 0; node < nodes(); ++node) {
    component[at(node)] = sets.setOf(node);
  }
  return component;
}

int NetworkBound::largestComponent() const {
  std::vector<int> size(mass_.size(), 0);
  for (const int component : components()) {
    ++size[at(component)];
  }
  return size.empty() ? 0 : *std::max_element(size.begin(), size.end());
}

double NetworkBound::collatzWielandtBound(int iterations) const {
  const std::size_t count = mass_.size();
  const std::vector<int> component = components();
  std::vector<double> x(count, 1.0);
  double best = kInfinity;
  for (int k = 0; k < iterations; ++k) {
    std::vector<double> y(count, 0.0);
    for (const Link& link : links_) {
      double strain = 0.0;
      for (const Share& share : link.ends) {
        strain += std::abs(share.weight) * x[at(share.node)];
      }
      for (const Share& share : link.ends) {
        y[at(share.node)] += load(link) * std::abs(share.weight) * strain / mass(share.node);
      }
    }
    double bound = 0.0;
    std::vector<double> largest(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      // Nodes without load are stable by themselves; their x has become 0.
      const double here = x[i] > 0.0 ? y[i] / x[i] : y[i];
      bound = here > bound || std::isnan(here) ? here : bound;
      double& peak = largest[at(component[i])];
      peak = std::max(peak, y[i]);
    }
    if (!std::isfinite(bound)) {
      return kInfinity;  // beyond what numbers can hold is no proof
    }
    best = std::min(best, bound);
    for (std::size_t i = 0; i < count; ++i) {
      const double peak = largest[at(component[i])];
      x[i] = peak > 0.0 ? y[i] / peak : 0.0;
    }
  }
  return best;
}

double NetworkBound::stableStep() const {
  const std::vector<double> stiffness = sums(1.0, 0.0);
  const std::vector<double> damping = sums(0.0, 1.0);
  double longest = kInfinity;
  for (const Link& link : links_) {
    if (!(load(link) > 0.0)) {
      continue;
    }
    // h^2 k + 2 h z = 4 with the sums of all its ends.
    double k = 0.0;
    double z = 0.0;
    for (const Share& share : link.ends) {
      k += std::abs(share.weight) * stiffness[at(share.node)] / mass(share.node);
      z += std::abs(share.weight) * damping[at(share.node)] / mass(share.node);
    }
    longest = std::min(longest, kLimit / (z + std::sqrt(z * z + kLimit * k)));
  }
  return longest;
}

bool NetworkBound::hasNegativeStiffness() const {
  return std::any_of(links_.begin(), links_.end(),
                     [](const Link& link) { return link.stiffness.lowest < 0.0; });
}

bool NetworkBound::hasNegativeDamping() const {
  return std::any_of(links_.begin(), links_.end(),
                     [](const Link& link) { return link.damping.lowest < 0.0; });
}

}  // namespace ergotic::physics
