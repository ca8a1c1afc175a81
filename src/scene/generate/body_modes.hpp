// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// The lowest modes of a body by itself, without its losses.
struct BodyModes {
  std::vector<Tuning::Mode> modes;  ///< by frequency
  Tuning::Mode top;                 ///< the highest of all
  /// Row i: first_mat + i, column: mode; 0 where a ground is. Of unit modal mass, kg^-1/2.
  Eigen::MatrixXd shapes;
};

/// The modes of its masses, springs and bends as written, with parameters at 1. The stiffness of a
/// mode is summed over the links, K e^2 each, so that low modes are as exact as high ones.
/// \param body   its ranges; scalar; `rigid` modes, the lowest, are left out
/// \param count  how many are wanted; fewer if there are fewer
/// Realtime: no. Cost: some hundred masses: O(n^3), more: a sparse factorisation
BodyModes lowestModes(const Scene& scene, const Tuning& body, int count);

}  // namespace ergotic::scene
