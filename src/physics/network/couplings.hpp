// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <vector>

#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// What joins two rates in one island: explicit links onto slower modules that forces move.
struct Coupling {
  std::set<int> slow_divisors;
  int slow_section = 0;  ///< of the slowest module that a link joins to a faster section
  int slowest = 0;       ///< its divisor
  int fastest = 0;       ///< that of the fastest link onto a module of slow_section
  double coupling_damping = 0.0;
  std::vector<int> nonlinear;  ///< links on modules of the island that are not linear
};

/// Of every island that has one, by its name.
std::map<int, Coupling> findCouplings(const RatedNetwork& networks);

}  // namespace ergotic::physics
