// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/points.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "ergotic/scene/grid.hpp"

namespace ergotic::scene {
namespace {

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

int addTap(SceneBuilder& builder, const std::string& name, Tap tap) {
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
  return scene.taps.back().mat;
}

}  // namespace ergotic::scene
