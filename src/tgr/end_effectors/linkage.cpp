// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/end_effectors/linkage.hpp"

#include <cmath>

#include "ergotic/exception.hpp"
#include "scene/limits.hpp"

namespace ergotic::tgr {

double restHeight(double rod, double offset) {
  const double shortest = offset / std::sqrt(1.0 - kFlattestRodAtRest * kFlattestRodAtRest);
  if (rod < shortest) {
    throw Exception("rod = " + scene::numberText(rod) + " m is too short for these radii, " +
                    "allowed: >= " + scene::numberText(shortest) + " m");
  }
  return std::sqrt(rod * rod - offset * offset);
}

}  // namespace ergotic::tgr
