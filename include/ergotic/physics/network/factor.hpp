// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace ergotic::physics {

/// A symmetric matrix of modules as L D L^T: it is positive definite, as all of D is positive.
struct Factor {
  struct Entry {
    int row = 0;
    int column = 0;
    double value = 0.0;
  };
  std::vector<int> modules;    ///< of its rows
  std::vector<double> pivots;  ///< D
  std::vector<Entry> below;    ///< L below its diagonal, which is 1
};

/// Of K and Z by themselves, at their softest and for unit masses, both with 1e-9 of their norm
/// added; none: nothing is negative.
struct SignProof {
  std::optional<Factor> stiffness;
  std::optional<Factor> damping;
};

}  // namespace ergotic::physics
