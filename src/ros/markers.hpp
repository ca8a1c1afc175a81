// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <visualization_msgs/MarkerArray.h>

#include "ergotic/scene/scene.hpp"

namespace ergotic::node {

/// Draws a scene for rviz: per section one POINTS and one LINE_LIST, in chunks of at most
/// `kChunkPoints` points (rviz slows down beyond), in frame `model`.
class Markers {
 public:
  static constexpr std::size_t kChunkPoints = 16000;

  /// \param displacement_scale  factor on every displacement: strings move by a millimetre
  Markers(const scene::Scene& scene, double displacement_scale);

  /// The picture at these displacements.
  /// \param displacements  [mats] m from rest along x of the section; anything not finite is drawn
  ///                       at rest
  const visualization_msgs::MarkerArray& draw(const std::vector<float>& displacements,
                                              const ::ros::Time& stamp);

  /// Wipes what an earlier model left.
  static visualization_msgs::MarkerArray eraseAll();

 private:
  using Indices = std::vector<std::size_t>;
  void addMarkers(const scene::Scene& scene, std::size_t section, int type, const Indices& mats);

  double scale_;
  std::vector<geometry_msgs::Point> rest_;    // [mats] in frame model
  std::vector<geometry_msgs::Vector3> axis_;  // [mats] direction of motion
  std::vector<Indices> points_;               // [markers] mats in the order of the points
  visualization_msgs::MarkerArray array_;
};

}  // namespace ergotic::node
