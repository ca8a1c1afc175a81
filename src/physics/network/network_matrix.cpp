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

std::vector<int> allNodes(const NetworkBound& network) {
  std::vector<int> nodes(at(network.nodes()));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

}  // namespace ergotic::physics
