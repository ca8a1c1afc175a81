// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "physics/layout/blocks/link_ends.hpp"

namespace ergotic::physics {

/// Start of the levels of an order.
enum class SparseSweep {
  kFromEnd,   ///< at a node at one end: best for nets in space and for ragged ones
  kFromSide,  ///< along a way from one corner to another: rows of membranes
};

/// An order of the nodes of a network in which linked nodes lie close together: networks that hang
/// together one after the other, each in levels of equal distance from where they begin (as Cuthill
/// and McKee 1969), and within a level from one side to the other. Realtime: no; the time goes with
/// the number of links.
/// \return [nodes] the node at each place
/// \throws Exception if a link ends outside 0...nodes-1
std::vector<int> sparseOrder(int nodes, const std::vector<LinkEnds>& links, SparseSweep sweep);

}  // namespace ergotic::physics
