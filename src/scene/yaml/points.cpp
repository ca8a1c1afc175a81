// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/points.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "ergotic/scene/grid.hpp"

namespace ergotic::scene {
namespace {

constexpr double kOnModule = 1e-9;  ///< of the spacing

/// The point that these modules take along.
Mat pointOn(const Scene& scene,
            const std::string& name,
            const std::vector<Tap::Share>& shares,
            Place place) {
  Mat point;
  point.name = name;
  point.type = MatType::kPoint;
  point.section = scene.mats[static_cast<std::size_t>(shares.front().mat)].section;
  point.place = place;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (const Tap::Share& share : shares) {
    const Mat& mat = scene.mats[static_cast<std::size_t>(share.mat)];
    point.rest += share.weight * mat.rest;
    point.position += share.weight * mat.position;
    velocity += share.weight * mat.push->velocity;
  }
  setVelocity(point, velocity);
  return point;
}

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
  return addPoint(builder, name, std::move(connection));
}

int addPoint(SceneBuilder& builder, const std::string& name, Connection connection) {
  Scene& scene = builder.scene();
  const GridPlace around = placeOf(scene, connection);
  std::vector<Tap::Share> shares;
  for (std::size_t i = 0; i < static_cast<std::size_t>(around.count); ++i) {
    shares.push_back({around.mats[i], around.weights[i]});
  }
  connection.mat = builder.add(pointOn(scene, name, shares, connection.place));
  scene.connections.push_back(connection);
  return connection.mat;
}

void addTap(SceneBuilder& builder, const std::string& name, Tap tap) {
  Scene& scene = builder.scene();
  Mat point = pointOn(scene, name, tap.shares, tap.place);
  // What does not move is seen in the middle, whatever the weights add up to.
  const int moving = dimensionsOf(scene.sectionOf(point).geometry);
  double whole = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Tap::Share& share : tap.shares) {
    whole += std::abs(share.weight);
    middle += std::abs(share.weight) * scene.mats[static_cast<std::size_t>(share.mat)].rest;
  }
  point.rest.tail(3 - moving) = middle.tail(3 - moving) / (whole > 0.0 ? whole : 1.0);
  tap.mat = builder.add(std::move(point));
  scene.taps.push_back(std::move(tap));
}

}  // namespace ergotic::scene
