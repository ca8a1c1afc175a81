// SPDX-License-Identifier: BSD-3-Clause
// What a network is at its softest: whether it is definite, and how far it gives way.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/network/network_matrix.hpp"
#include "physics/network/network_spectrum.hpp"

namespace ergotic::physics {
namespace {

constexpr double kHeld = 4e-9;  // of the norm: half of it is definite all the same
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double stiffnessOf(const NetworkBound::Link& link) {
  return link.stiffness.lowest;
}
double dampingOf(const NetworkBound::Link& link) {
  return link.damping.lowest;
}

/// What shows that the eigenvalues of some rows are above a margin. \param margin  of their norm
std::optional<Factor> factorAbove(const NetworkBound& network,
                                  const Matrix& lower,
                                  const std::vector<int>& nodes,
                                  double margin) {
  if (!isFinite(lower)) {
    return std::nullopt;
  }
  const double norm = normOf(lower);
  if (norm == 0.0) {
    return std::nullopt;
  }
  Matrix shifted = lower;
  for (int i = 0; i < shifted.rows(); ++i) {
    shifted.coeffRef(i, i) -= margin * norm;
  }
  const Eigen::SimplicialLDLT<Matrix> solver(shifted);
  return allPivotsPositive(solver) ? std::optional<Factor>(factorOf(solver, network, nodes))
                                   : std::nullopt;
}

/// All that hangs together with some nodes.
template <class CoefficientOf>
std::vector<int> nodesBeside(const NetworkBound& network,
                             const std::vector<int>& some,
                             CoefficientOf coefficient) {
  DisjointSets bodies(at(network.nodes()));
  for (const NetworkBound::Link& link : network.links()) {
    for (const Share& end : link.ends) {
      if (coefficient(link) != 0.0) {
        bodies.join(end.node, link.ends.front().node);
      }
    }
  }
  std::set<int> names;
  for (const int node : some) {
    names.insert(bodies.setOf(node));
  }
  std::vector<int> nodes = allNodes(network);
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(),
                             [&](int n) { return names.count(bodies.setOf(n)) == 0; }),
              nodes.end());
  return nodes;
}

template <class CoefficientOf>
std::vector<int> negativeNodes(const NetworkBound& network, CoefficientOf coefficient) {
  std::vector<int> nodes;
  for (const NetworkBound::Link& link : network.links()) {
    if (coefficient(link) < 0.0 && !link.ends.empty()) {
      nodes.push_back(link.ends.front().node);
    }
  }
  return nodes;
}

/// As assemble(), of some nodes.
template <class CoefficientOf>
Matrix assemblePart(const NetworkBound& network,
                    const std::vector<int>& nodes,
                    CoefficientOf coefficient) {
  Matrix select(network.nodes(), static_cast<int>(nodes.size()));
  for (int row = 0; row < select.cols(); ++row) {
    select.insert(nodes[at(row)], row) = 1.0;
  }
  const Matrix lower = assemble(network, scaleOf(network), coefficient);
  const Matrix whole = lower.selfadjointView<Eigen::Lower>();
  return Matrix(select.transpose() * whole * select).triangularView<Eigen::Lower>();
}

/// What is negative lets all that hangs together with it grow unless the whole is definite: how
/// slowly is a matter of the norm, but however little is missing it grows.
template <class CoefficientOf>
std::optional<Factor> definiteBesideNegative(const NetworkBound& network,
                                             CoefficientOf coefficient) {
  const std::vector<int> nodes =
      nodesBeside(network, negativeNodes(network, coefficient), coefficient);
  return factorAbove(network, assemblePart(network, nodes, coefficient), nodes, kPivotMargin);
}

/// u' A^-1 u for the weights u at some nodes, A of a positive coefficient.
template <class CoefficientOf>
double giveOf(const NetworkBound& network, const Shares& u, CoefficientOf coefficient) {
  std::vector<int> ends;
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(network.nodes());
  for (const Share& share : u) {
    ends.push_back(share.node);
    pull[share.node] += share.weight / std::sqrt(network.mass(share.node));
  }
  const std::vector<int> nodes = nodesBeside(network, ends, coefficient);
  Matrix held = assemblePart(network, nodes, coefficient);
  const double margin = kHeld * normOf(held);
  Eigen::VectorXd force(held.rows());
  for (int row = 0; row < held.rows(); ++row) {
    held.coeffRef(row, row) -= margin;
    force[row] = pull[nodes[at(row)]];
  }
  if (!(margin > 0.0) || !physics::isFinite(held)) {
    return kInfinity;
  }
  const Eigen::SimplicialLDLT<Matrix> solver(held);
  return allPivotsPositive(solver) ? force.dot(solver.solve(force)) : kInfinity;
}

}  // namespace

std::optional<Factor> NetworkSpectrum::semidefiniteStiffness(const NetworkBound& network) {
  return definiteBesideNegative(network, stiffnessOf);
}

std::optional<Factor> NetworkSpectrum::semidefiniteDamping(const NetworkBound& network) {
  return definiteBesideNegative(network, dampingOf);
}

std::optional<Factor> NetworkSpectrum::definiteDamping(const NetworkBound& network) {
  const Matrix softest = assemble(network, scaleOf(network), dampingOf);
  return factorAbove(network, softest, allNodes(network), kPivotMargin);
}

double NetworkSpectrum::softness(const NetworkBound& network, const Shares& u) {
  return giveOf(network, u, stiffnessOf);
}

double NetworkSpectrum::mobility(const NetworkBound& network, const Shares& u) {
  return giveOf(network, u, dampingOf);
}

}  // namespace ergotic::physics
