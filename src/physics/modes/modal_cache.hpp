// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "physics/modes/modal_parts.hpp"

namespace ergotic::physics {

/// Eigenvectors of a symmetric matrix, by ascending eigenvalue.
struct Modes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< orthonormal columns
};

/// Folder where modes are kept between runs: $XDG_CACHE_HOME/ergotic/modes or
/// ~/.cache/ergotic/modes; empty if $ERGOTIC_MODE_CACHE is `off` or there is no home.
std::filesystem::path modeCacheFolder();

/// File in which the modes of a matrix are kept, by its numbers.
std::filesystem::path modeCacheFile(const ModalMatrix& matrix);

/// The modes of a matrix: from the cache, or worked out and put there. A file that is damaged or
/// not ours is worked out again and replaced; what is wrong with it, or why it cannot be written,
/// is added to `notes`. Realtime: no. Cost: O(size^3) if not in the cache
/// \throws Exception if the eigenvalues do not converge
std::shared_ptr<const Modes> modesOf(const ModalMatrix& matrix, std::vector<std::string>& notes);

}  // namespace ergotic::physics
