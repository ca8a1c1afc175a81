// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/settling/chaplet.hpp"
#include "physics/network/linear_network.hpp"

namespace ergotic::physics {

/// The load at a module or point that is touched.
/// \param nyquist  wN, rad/s: a module without links is a load wN M
/// \pre network.moves(mat)
inline ChapletLoad loadAt(const LinearNetwork& network, int mat, double nyquist) {
  const double impedance = network.impedanceAt(mat);
  return {network.stiffnessAt(mat), impedance > 0.0 ? impedance : nyquist * network.massAt(mat)};
}

}  // namespace ergotic::physics
