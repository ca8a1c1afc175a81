// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/points.hpp"

#include <cmath>

#include "scene/generate/points.hpp"
#include "scene/yaml/selections.hpp"

namespace ergotic::scene {
namespace {

constexpr double kOnModule = 1e-9;  ///< part of the spacing

}  // namespace

NamedPlace namedPlace(const SceneBuilder& builder, const std::string& text, Place place) {
  const std::size_t at_sign = text.find('@');
  NamedPlace result;
  result.grid = builder.grid(text.substr(0, at_sign), place);
  const Grid& grid = builder.scene().grids[static_cast<std::size_t>(result.grid)];
  const std::string numbers = text.substr(at_sign + 1);
  const std::size_t colon = numbers.find(':');
  if ((colon == std::string::npos) != (grid.rows == 1)) {
    builder.fail(place, quoted(text) + " is no point of " + quoted(grid.name) + ", allowed: " +
                            grid.name + (grid.rows == 1 ? "@0.3" : "@0.3:0.7") + " and the like");
  }
  const std::string what = "fraction of " + quoted(text);
  result.along = numberIn(builder, numbers.substr(0, colon), what, kFractionLimits, place);
  if (grid.rows > 1) {
    result.across = numberIn(builder, numbers.substr(colon + 1), what, kFractionLimits, place);
  }
  return result;
}

int moduleOn(const Grid& grid, const NamedPlace& at) {
  const double column = at.along * (grid.columns - 1);
  const double row = at.across * (grid.rows - 1);
  const double whole_column = std::round(column);
  const double whole_row = std::round(row);
  if (std::abs(column - whole_column) > kOnModule || std::abs(row - whole_row) > kOnModule) {
    return -1;
  }
  return grid.first + static_cast<int>(whole_row) * grid.columns + static_cast<int>(whole_column);
}

int pointAt(SceneBuilder& builder, const std::string& text, Place place) {
  if (isSelection(text)) {
    return selectedModule(builder, text, place);
  }
  if (text.find('@') == std::string::npos) {
    return builder.mat(text, place);
  }
  const NamedPlace at = namedPlace(builder, text, place);
  const Grid& grid = builder.scene().grids[static_cast<std::size_t>(at.grid)];
  const int module = moduleOn(grid, at);
  if (module >= 0) {
    return module;
  }
  std::string name = grid.name + "@" + numberText(at.along);
  if (grid.rows > 1) {
    name += ":" + numberText(at.across);
  }
  const int known = builder.findMat(name);
  if (known >= 0) {
    return known;
  }
  Connection connection;
  connection.grid = at.grid;
  connection.along.at = {at.along};
  connection.across.at = {at.across};
  connection.place = place;
  return addPoint(builder, name, connection);
}

}  // namespace ergotic::scene
