// SPDX-License-Identifier: BSD-3-Clause
#include "physics/network/network_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "at.hpp"

namespace ergotic::physics {

Eigen::VectorXd scaleOf(const NetworkBound& network) {
  Eigen::VectorXd scale(network.nodes());
  for (int i = 0; i < network.nodes(); ++i) {
    scale[i] = 1.0 / std::sqrt(network.mass(i));
  }
  return scale;
}

bool isFinite(const Matrix& matrix) {
  return std::all_of(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(),
                     [](double v) { return std::isfinite(v); });
}

bool allPivotsPositive(const Eigen::SimplicialLDLT<Matrix>& solver) {
  return solver.info() == Eigen::Success && (solver.vectorD().array() > 0.0).all();
}

Factor factorOf(const Eigen::SimplicialLDLT<Matrix>& solver,
                const NetworkBound& network,
                const std::vector<int>& nodes) {
  Factor factor;
  const Eigen::VectorXd pivots = solver.vectorD();
  factor.pivots.assign(pivots.begin(), pivots.end());
  factor.modules.resize(factor.pivots.size());
  for (int row = 0; row < static_cast<int>(nodes.size()); ++row) {
    factor.modules[at(solver.permutationP().indices()[row])] = network.ownerOf(nodes[at(row)]);
  }
  const Matrix& below = solver.matrixL().nestedExpression();
  for (int column = 0; column < below.outerSize(); ++column) {
    for (Matrix::InnerIterator it(below, column); it; ++it) {
      factor.below.push_back({static_cast<int>(it.row()), column, it.value()});
    }
  }
  return factor;
}

std::vector<int> allNodes(const NetworkBound& network) {
  std::vector<int> nodes(at(network.nodes()));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

}  // namespace ergotic::physics
