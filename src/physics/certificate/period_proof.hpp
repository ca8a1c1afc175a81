// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/certificate/monodromy.hpp"
#include "ergotic/physics/certificate/proof.hpp"

namespace ergotic::physics {

/// A quadratic form that a period does not raise; none if what rounding leaves of it proves
/// nothing, and where modes are so near to meeting that rounding of the scene's numbers may take
/// them there. `parameters` and `frames` are left to the caller.
///
/// Modes that hardly fade: their left eigenvectors. The others lose so much that the form follows
/// from a Lyapunov equation. Realtime: no. Cost: some four times that of the eigenvalues.
/// \param rounded  the same period with the scene's numbers off by what rounding may do to them
std::optional<PeriodProof> proofOf(const Period& period,
                                   const std::vector<Eigen::MatrixXd>& rounded);

}  // namespace ergotic::physics
