// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// Values of a table beyond its ends, where it holds its last values; 0 without a table.
struct TableEnds {
  double low = 0.0;
  double high = 0.0;

  TableEnds operator+(double force) const { return {low + force, high + force}; }
  /// True if one of them pushes outwards: over elongation, the potential has no lower bound.
  bool push() const { return low > 0.0 || high < 0.0; }
  /// Constant part without which no side of the rest pushes outwards. \pre low <= high
  double constant() const { return std::clamp(0.0, low, high); }
};

TableEnds endsOf(const Table& table);

/// Force of a viscous table at rest; 0 without a table.
double forceAtRest(const Lia& lia);

}  // namespace ergotic::scene
