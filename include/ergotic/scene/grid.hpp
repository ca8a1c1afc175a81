// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "ergotic/scene/scene.hpp"

namespace ergotic::scene {

/// The modules around a place on a grid and how much each counts: two of a string, four of a mesh.
/// The weights are >= 0 and add up to 1; one that is 0 is kept, so that the count never changes.
struct GridPlace {
  int count = 0;
  std::array<int, 4> mats{};  ///< indices in Scene::mats
  std::array<double, 4> weights{};
};

/// Linear interpolation along the columns and across the rows.
/// \param along, across  0...1, cut to that; `across` does not matter where there is one row. One
///                       that is not a number gives modules of the grid with weights that are none
/// \pre at least two columns. Realtime: yes.
inline GridPlace placeOn(const Grid& grid, double along, double across) noexcept {
  const auto split = [](double place, int count, int& lower) noexcept {
    const double index = std::clamp(place, 0.0, 1.0) * (count - 1);
    // No index comes from what is not a number: the weights tell.
    lower = index >= 1.0 ? std::min(static_cast<int>(index), count - 2) : 0;
    return index - lower;
  };
  int column = 0;
  const double right = split(along, grid.columns, column);
  const int corner = grid.first + column;
  GridPlace place;
  if (grid.rows == 1) {
    place.count = 2;
    place.mats = {corner, corner + 1, corner, corner};
    place.weights = {1.0 - right, right, 0.0, 0.0};
    return place;
  }
  int row = 0;
  const double down = split(across, grid.rows, row);
  const int top = corner + row * grid.columns;
  const int bottom = top + grid.columns;
  place.count = 4;
  place.mats = {top, top + 1, bottom, bottom + 1};
  place.weights = {(1.0 - down) * (1.0 - right), (1.0 - down) * right, down * (1.0 - right),
                   down * right};
  return place;
}

/// Position of a point on its grid while nothing leads it.
inline GridPlace placeOf(const Scene& scene, const Connection& point) {
  const auto fraction = [&](const Connection::Way& way) {
    return std::clamp(scene.valueOf(way.at), way.minimum, way.maximum);
  };
  return placeOn(scene.grids[static_cast<std::size_t>(point.grid)], fraction(point.along),
                 fraction(point.across));
}

}  // namespace ergotic::scene
