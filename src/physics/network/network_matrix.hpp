// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "physics/network/load_matrix.hpp"
#include "physics/network/network_bound.hpp"

namespace ergotic::physics {

using Matrix = Eigen::SparseMatrix<double>;

constexpr double kPivotMargin = 1e-9;  ///< part of a norm, for rounding

/// M^-1/2 of every node.
Eigen::VectorXd scaleOf(const NetworkBound& network);

/// Lower triangle of sum k u u^T for unit masses, with a place for every pair of nodes of a link
/// and for the diagonal.
template <class CoefficientOf>
Matrix assemble(const NetworkBound& network,
                const Eigen::VectorXd& scale,
                CoefficientOf coefficient) {
  LoadMatrix matrix(network.nodes());
  for (int i = 0; i < network.nodes(); ++i) {
    matrix.add(i, i, 0.0);
  }
  for (const NetworkBound::Link& link : network.links()) {
    const double k = coefficient(link);
    for (const Share& a : link.ends) {
      for (const Share& b : link.ends) {
        if (a.node >= b.node) {
          const double u = a.weight * scale[a.node];
          matrix.add(a.node, b.node, k * u * (b.weight * scale[b.node]));
        }
      }
    }
  }
  return matrix.sum();
}

/// True if all entries of a lower triangle are finite.
bool isFinite(const Matrix& lower);

bool allPivotsPositive(const Eigen::SimplicialLDLT<Matrix>& solver);

std::vector<int> allNodes(const NetworkBound& network);

}  // namespace ergotic::physics
