// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// The linear part of a scene over a period, from one step of all sections to the next one that
/// they have together (at least one tick), as a matrix: stepped by the instrument itself from unit
/// states, so it is what is played.
///
/// Linear part: the links that are springs or dampers, and K and Z of two-sided nonlinear ones;
/// contacts open, pluck and bow away, energy-stable links away; hands and driven modules held;
/// moving points where they are at the start; Euclidean sections as scalar ones. Parameters have
/// their present values.
///
/// State: displacements of the n modules that forces move, then what they are about to move by, in
/// units of their own; shape (2n, 2n). Eigenvalues do not depend on these units.
struct Period {
  Eigen::MatrixXd matrix;
  std::vector<int> modules;   ///< the n, indices in Scene::mats
  Eigen::VectorXd units;      ///< m, of what they are about to move by
  Eigen::MatrixXd stiffness;  ///< (n, n), N/m, of displacements
  Eigen::VectorXd inertia;    ///< M/h^2 in these units, of what they are about to move by
};
/// Realtime: no. Cost: 3n periods.
/// \throws Exception if the scene cannot be compiled at these rates
Period periodOf(const scene::Scene& scene, const Rates& rates);
/// The matrix of periodOf() alone.
inline Eigen::MatrixXd monodromy(const scene::Scene& scene, const Rates& rates) {
  return periodOf(scene, rates).matrix;
}

/// Largest absolute eigenvalue; 0 of an empty matrix. A rigid motion is a double eigenvalue 1 that
/// rounding splits: one within 1e-6 of 1 is worked out again without the states that stay as is.
/// Realtime: no. Cost: O(rows^3), about 1 s for 600 rows.
double spectralRadius(const Eigen::MatrixXd& matrix);

}  // namespace ergotic::physics
