// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "physics/layout/blocks/lanes.hpp"
#include "physics/layout/blocks/link_ends.hpp"

namespace ergotic::physics {

/// One step of an irregular network, for 16 nodes at a time: a list of slots, each of which has one
/// neighbour for each of the 16. Neighbours that lie close together are picked from a window of 32
/// nodes, the others one by one.
struct SparseProgram {
  /// Position of the coefficients of a link: index in the [slots][kLanes] of either end.
  struct Sides {
    std::size_t a = 0;
    std::size_t b = 0;
  };

  int nodes = 0;
  int groups = 0;  ///< of kLanes nodes
  int span = 0;    ///< groups between a node and its farthest neighbour, at most
  /// First window and first pick of each group, and their number: [groups + 1]. The slots of a
  /// group are its windows, then its picks; its first slot is first_window + first_pick.
  std::vector<std::uint32_t> first_window;
  std::vector<std::uint32_t> first_pick;
  std::vector<std::uint32_t> window;   ///< [windows] its first node, a multiple of kLanes
  std::vector<std::uint8_t> lane;      ///< [windows][kLanes] place in the window, 0...31
  std::vector<std::uint32_t> pick;     ///< [picks][kLanes] node
  std::vector<std::uint16_t> present;  ///< [slots] a bit for each lane that has a neighbour
  std::vector<Sides> sides;            ///< [links]

  std::size_t slots() const { return window.size() + pick.size() / kLanes; }
  double cost() const;  ///< time of a step, in slots of windows
  /// How many nodes an array that the program reads must have.
  int reach() const { return kLanes * (groups < 2 ? 2 : groups); }
};

/// `links` join places of an order in which linked nodes are close. Realtime: no.
/// \throws Exception if a link ends outside 0...nodes-1
SparseProgram makeSparseProgram(int nodes, const std::vector<LinkEnds>& links);

struct SparsePlan {
  std::vector<int> order;  ///< [nodes] the node at each place
  SparseProgram program;   ///< program for the nodes in that order
};

/// The order that costs least, of the given one, which may be that of a generator, and those of
/// sparseOrder, and its program. Realtime: no. \throws Exception if a link ends outside 0...nodes-1
SparsePlan planSparse(int nodes, const std::vector<LinkEnds>& links);

}  // namespace ergotic::physics
