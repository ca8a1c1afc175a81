// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::physics {

/// Blocks begin at multiples of this and are as long: one row of chains side by side. All sums over
/// a block keep one part for each lane, so that every level of vector instructions gives the same
/// bits.
constexpr int kLanes = 16;
/// Diagonals that one pass over a lattice takes; more need further passes.
constexpr int kMaxDiagonals = 4;

}  // namespace ergotic::physics
