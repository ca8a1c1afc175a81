// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/certificate/monodromy.hpp"

namespace ergotic::physics {

/// A quadratic form |G s|^2, a Lyapunov function, that no period of coupled rates raises by more
/// than rounding: with s the displacements of the modules and then what they are about to move by,
/// m, G s becomes B G s.
struct LyapunovForm {
  Eigen::MatrixXd form;  ///< G, shape (rows, 2 modules); of what a period keeps as it is, 0
  Eigen::MatrixXd turn;  ///< B, shape (rows, rows)
};

/// Finds such a form. nullopt if rounding makes it useless, or if eigenvalues lie so close together
/// that rounding of the scene's numbers may make them coincide.
///
/// For modes that hardly decay, the rows are their left eigenvectors. The others lose so much that
/// the form follows from a Lyapunov equation. Realtime: no. Cost: some four times that of the
/// eigenvalues.
/// \param rounded  the same period with the scene's numbers off by what rounding may do to them
std::optional<LyapunovForm> lyapunovFormOf(const Period& period,
                                           const std::vector<Eigen::MatrixXd>& rounded);

}  // namespace ergotic::physics
