// SPDX-License-Identifier: BSD-3-Clause
#include "network_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ergotic::physics {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Connected components by union-find.
class Components {
 public:
  explicit Components(std::size_t nodes) : parent_(nodes) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int node) {
    while (parent_[at(node)] != node) {
      parent_[at(node)] = parent_[at(parent_[at(node)])];
      node = parent_[at(node)];
    }
    return node;
  }
  void join(int a, int b) { parent_[at(find(a))] = find(b); }

 private:
  std::vector<int> parent_;
};

}  // namespace

int NetworkBound::addNode(double mass, int owner) {
  mass_.push_back(mass);
  owner_.push_back(owner);
  stiffness_sum_.push_back(0.0);
  damping_sum_.push_back(0.0);
  return static_cast<int>(mass_.size()) - 1;
}

void NetworkBound::addLink(int a, int b, double stiffness, double damping, int label) {
  links_.push_back({a, b, stiffness, damping, label});
  for (const int end : {a, b}) {
    if (end != kFixed) {
      stiffness_sum_[at(end)] += stiffness;
      damping_sum_[at(end)] += damping;
    }
  }
}

double NetworkBound::ratio(int node) const {
  if (node == kFixed) {
    return 0.0;
  }
  return (step_ * step_ * stiffness_sum_[at(node)] + 2.0 * step_ * damping_sum_[at(node)]) /
         mass_[at(node)];
}

const NetworkBound::Link* NetworkBound::worst() const {
  const auto found = std::max_element(links_.begin(), links_.end(),
                                      [this](auto& l, auto& r) { return bound(l) < bound(r); });
  return found == links_.end() ? nullptr : &*found;
}

double NetworkBound::linkBound() const {
  const Link* link = worst();
  return link == nullptr ? 0.0 : bound(*link);
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
  const bool take_a = link->b == kFixed || (link->a != kFixed && ratio(link->a) > ratio(link->b));
  const int node = take_a ? link->a : link->b;
  return node == kFixed ? -1 : owner_[at(node)];
}

double NetworkBound::collatzWielandtBound(int iterations) const {
  const std::size_t nodes = mass_.size();
  Components components(nodes);
  for (const Link& link : links_) {
    if (link.a != kFixed && link.b != kFixed && load(link) > 0.0) {
      components.join(link.a, link.b);
    }
  }
  std::vector<double> x(nodes, 1.0);
  std::vector<double> y(nodes);
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < iterations; ++k) {
    for (std::size_t i = 0; i < nodes; ++i) {
      y[i] = ratio(static_cast<int>(i)) * x[i];
    }
    for (const Link& link : links_) {
      if (link.a != kFixed && link.b != kFixed) {
        y[at(link.a)] += load(link) / mass_[at(link.a)] * x[at(link.b)];
        y[at(link.b)] += load(link) / mass_[at(link.b)] * x[at(link.a)];
      }
    }
    double bound = 0.0;
    std::vector<double> largest(nodes, 0.0);
    for (std::size_t i = 0; i < nodes; ++i) {
      // Nodes without load are stable by themselves; their x has become 0.
      const double here = x[i] > 0.0 ? y[i] / x[i] : y[i];
      bound = here > bound || std::isnan(here) ? here : bound;
      double& peak = largest[at(components.find(static_cast<int>(i)))];
      peak = std::max(peak, y[i]);
    }
    if (!std::isfinite(bound)) {
      return std::numeric_limits<double>::infinity();  // beyond what numbers can hold is no proof
    }
    best = std::min(best, bound);
    for (std::size_t i = 0; i < nodes; ++i) {
      const double peak = largest[at(components.find(static_cast<int>(i)))];
      x[i] = peak > 0.0 ? y[i] / peak : 0.0;
    }
  }
  return best;
}

double NetworkBound::stableStep() const {
  double longest = std::numeric_limits<double>::infinity();
  for (const Link& link : links_) {
    // h^2 k + 2 h z = 4 with the sums of both ends.
    double k = 0.0;
    double z = 0.0;
    for (const int end : {link.a, link.b}) {
      if (end != kFixed) {
        k += stiffness_sum_[at(end)] / mass_[at(end)];
        z += damping_sum_[at(end)] / mass_[at(end)];
      }
    }
    if (k > 0.0) {
      longest = std::min(longest, (std::sqrt(z * z + kLimit * k) - z) / k);
    } else if (z > 0.0) {
      longest = std::min(longest, kLimit / (2.0 * z));
    }
  }
  return longest;
}

}  // namespace ergotic::physics
