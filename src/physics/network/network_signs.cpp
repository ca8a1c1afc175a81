// SPDX-License-Identifier: BSD-3-Clause
// What a network is at its softest: whether it is definite, and how far it gives way.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include "at.hpp"
#include "constants.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/network/network_matrix.hpp"
#include "physics/network/network_spectrum.hpp"

namespace ergotic::physics {
namespace {

// Of the norm: single precision rounds each number by 6e-8 of itself, and what is negative lets
// that grow.
constexpr double kSignMargin = 1e-6;
constexpr double kHeld = 2e-5;  // of the norm: a tenth of it is definite all the same

double stiffnessOf(const NetworkBound::Link& link) {
  return link.stiffness.lowest;
}
double dampingOf(const NetworkBound::Link& link) {
  return link.damping.lowest;
}

/// Norm of the matrix of some nodes with all terms taken as positive: rounding errors are relative
/// to it.
template <class CoefficientOf>
double normOfParts(const NetworkBound& network,
                   const std::vector<int>& nodes,
                   CoefficientOf coefficient) {
  const Eigen::VectorXd scale = scaleOf(network);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(network.nodes());
  for (const NetworkBound::Link& link : network.links()) {
    double length = 0.0;
    for (const Share& end : link.ends) {
      length += std::abs(end.weight) * scale[end.node];
    }
    for (const Share& end : link.ends) {
      sums[end.node] +=
          std::abs(coefficient(link)) * length * std::abs(end.weight) * scale[end.node];
    }
  }
  double norm = 0.0;
  for (const int node : nodes) {
    norm = std::max(norm, sums[node]);
  }
  return norm;
}

/// Whether the eigenvalues of a lower triangle are above a margin.
bool isAbove(Matrix lower, double margin) {
  if (!isFinite(lower) || !(margin > 0.0) || !std::isfinite(margin)) {
    return false;
  }
  for (int i = 0; i < lower.rows(); ++i) {
    lower.coeffRef(i, i) -= margin;
  }
  return allPivotsPositive(Eigen::SimplicialLDLT<Matrix>(lower));
}

/// All nodes of the bodies that some nodes belong to.
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

/// The matrix of assemble() for some nodes alone.
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

/// Modules that are joined with a negative coefficient; nullopt if their matrix is not positive
/// definite. Motion then grows: how slowly depends on the norm, but it grows however little is
/// missing.
template <class CoefficientOf>
std::optional<std::vector<int>> definiteBesideNegative(const NetworkBound& network,
                                                       CoefficientOf coefficient) {
  const std::vector<int> nodes =
      nodesBeside(network, negativeNodes(network, coefficient), coefficient);
  if (!isAbove(assemblePart(network, nodes, coefficient),
               kSignMargin * normOfParts(network, nodes, coefficient))) {
    return std::nullopt;
  }
  std::vector<int> modules;
  std::transform(nodes.begin(), nodes.end(), std::back_inserter(modules),
                 [&](int node) { return network.ownerOf(node); });
  return modules;
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
  const double margin = kHeld * normOfParts(network, nodes, coefficient);
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

std::optional<std::vector<int>> NetworkSpectrum::semidefiniteStiffness(
    const NetworkBound& network) {
  return definiteBesideNegative(network, stiffnessOf);
}

std::optional<std::vector<int>> NetworkSpectrum::semidefiniteDamping(const NetworkBound& network) {
  return definiteBesideNegative(network, dampingOf);
}

bool NetworkSpectrum::hasDefiniteDamping(const NetworkBound& network) {
  return isAbove(assemble(network, scaleOf(network), dampingOf),
                 kPivotMargin * normOfParts(network, allNodes(network), dampingOf));
}

double NetworkSpectrum::softness(const NetworkBound& network, const Shares& u) {
  return giveOf(network, u, stiffnessOf);
}

double NetworkSpectrum::mobility(const NetworkBound& network, const Shares& u) {
  return giveOf(network, u, dampingOf);
}

}  // namespace ergotic::physics
