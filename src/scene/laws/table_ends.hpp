// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// What a table gives beyond its ends where it holds its last values, 0 without one.
struct TableEnds {
  double low = 0.0;
  double high = 0.0;

  TableEnds operator+(double force) const { return {low + force, high + force}; }
  /// One of them outwards: over elongation, its potential has no floor.
  bool push() const { return low > 0.0 || high < 0.0; }
  /// What is left without it pushes outwards on no side. \pre low <= high
  double constant() const { return std::clamp(0.0, low, high); }
};

TableEnds endsOf(const Table& table);

/// What a viscous table gives at rest, 0 without one.
double forceAtRest(const Lia& lia);

}  // namespace ergotic::scene
