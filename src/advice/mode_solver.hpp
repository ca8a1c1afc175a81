// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "advice/mode_network.hpp"

namespace ergotic::physics {

/// h^2 w^2 of the modes that are wanted.
struct EigenWindow {
  double from = 0.0;  ///< 0: from the lowest on, negative ones as well
  double to = 0.0;
  int most = 1;  ///< most modes, of those that do not move as a whole
};

struct EigenPairs {
  Eigen::VectorXd values;   ///< ascending; with those of `rigid` first, and some beyond `most`
  Eigen::MatrixXd vectors;  ///< a unit one in each column
  int rigid = 0;            ///< among `values`: no energy in any load
  int rigid_in_all = 0;     ///< in the matrix; more than `rigid` where they are not worked out
  int counted = 0;          ///< modes in the window, rigid ones left out
  bool is_certain = true;   ///< the counts are beyond the rounding of their factors
};

/// Eigenpairs of `pull` of a part: small ones densely, larger ones by shift and invert. How many
/// there are is told by the signs of factors (Sylvester), and single vectors are iterated again
/// beside all that were found until none is missing: equal pitches are found as often as they
/// are there. Eigenvalues are the energy of their vectors, load by load, without cancellation.
/// \throws Exception if some cannot be found
EigenPairs eigenPairsIn(const ModePart& part, const EigenWindow& window);

constexpr int kMaxDenseRows = 300;

}  // namespace ergotic::physics
