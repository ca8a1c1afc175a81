// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "physics/network/network.hpp"

namespace ergotic::physics {

/// A symmetric matrix of loads. Those of one entry are summed in the order in which they came.
class LoadMatrix {
 public:
  explicit LoadMatrix(int nodes, int dimensions = 1) : nodes_(nodes), dimensions_(dimensions) {}

  void add(int row, int column, double value) { entries_.emplace_back(row, column, value); }
  /// \param block  its upper left corner counts, as large as there are dimensions
  void add(int row, int column, const Eigen::Matrix3d& block) {
    for (int i = 0; i < dimensions_; ++i) {
      for (int j = 0; j < dimensions_; ++j) {
        add(dimensions_ * row + i, dimensions_ * column + j, block(i, j));
      }
    }
  }
  /// A load on its ends. \param entry  what two shares give to their rows: a number or a block
  template <class Entry>
  void addLoad(const Shares& ends, const Entry& entry) {
    for (const Share& a : ends) {
      for (const Share& b : ends) {
        add(a.node, b.node, entry(a, b));
      }
    }
  }

  Eigen::SparseMatrix<double> sum() const {
    const int size = dimensions_ * nodes_;
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

 private:
  int nodes_;
  int dimensions_;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace ergotic::physics
