// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <vector>

#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// Coupling of two rates within an island: explicit links to slower modules that forces move.
struct Coupling {
  std::set<int> slow_divisors;
  int slow_section = 0;  ///< section of the slowest module that a link joins to a faster section
  int slowest = 0;       ///< its divisor
  int fastest = 0;       ///< divisor of the fastest link to a module of slow_section
  double coupling_damping = 0.0;
  std::vector<int> nonlinear;  ///< links on modules of the island that are not linear
};

/// Finds the coupling of every island that has one, by the island's name.
std::map<int, Coupling> findCouplings(const RatedNetwork& networks);

}  // namespace ergotic::physics
