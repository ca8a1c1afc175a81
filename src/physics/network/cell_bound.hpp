// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "physics/network/network_bound.hpp"

namespace ergotic::physics {

/// Upper bound of the largest eigenvalue from the cells of the network's grids: the network is cut
/// into cells, every link goes in parts to the cells that hold all its nodes (to one of its
/// own if none does), every mass to its cells by how much they load it, and the largest eigenvalue
/// of a cell by itself is a bound of the whole. With every link a cell of its own that would be the
/// link bound; cells of four see that the diagonals of a net and its sides cannot all be strained
/// at once, and are exact in the limit for homogeneous nets with or without diagonals.
/// Cost: O(links + cells).
/// Source: Irons and Treharne 1971 (the bound of a finite element mesh by its elements).
double cellBound(const NetworkBound& network);

/// A lower bound of the largest eigenvalue, links at their stiffest and moving links left out: the
/// Rayleigh quotient after some power iterations from a fixed direction. O(links * iterations)
double rayleighQuotient(const NetworkBound& network, int iterations);

}  // namespace ergotic::physics
