// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// True if forces move the module.
bool isFree(const scene::Mat& mat);

/// [mats] 1 if a hand moves the module and lets it go.
using Hands = std::vector<unsigned char>;
std::vector<int> slicesInHands(const scene::Scene& scene);
Hands handsOn(const scene::Scene& scene, const std::vector<int>& slices);

/// Nodes that links join to a slice: modules that forces move, the 16 nearest if there are too
/// many; points; and the slices among them.
struct Attached {
  std::set<int> nodes;
  std::vector<int> slices;
  int masses = 0;
  bool is_cut = false;  ///< there are more
};
/// \param hands  that let go; what the others move is held
/// \param most   modules that are not too many
Attached attachedTo(int slice, const Network& network, const Hands& hands, int most);

/// The whole body that is attached to a slice, at whatever positions its points may be led to.
Attached bodyOn(int slice, const Network& network, const Hands& hands);

/// The scene reduced to what is attached: other modules become grounds, links among them are
/// removed.
scene::Scene onlyOf(const Attached& attached, scene::Scene scene);

/// Why what a slice meets cannot be told from it, whatever is attached there: fewer modes than
/// modules, or a point that it moves, far along what is not straight or by way of what else its
/// points move, and pulls at. nullptr: it can be.
const char* notTold(const Attached& body, const Network& network);

/// Why it cannot be worked out as a scalar network at the rate of the slice; nullptr: it can be.
const char* notWorkedOut(const Attached& attached, const scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
