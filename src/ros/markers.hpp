// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <visualization_msgs/MarkerArray.h>

#include "ergotic/scene/scene.hpp"

namespace ergotic::node {

/// Draws a scene for rviz: per section one POINTS and one LINE_LIST, in chunks of at most
/// `kChunkPoints` points (rviz slows down beyond), in frame `model`.
class Markers {
 public:
  static constexpr std::size_t kChunkPoints = 16000;

  /// \param zoom  of x about x = 0 of every section, as maps exaggerate height: strings move by
  ///              millimetres. What touches in the model touches in the picture
  Markers(const scene::Scene& scene, double zoom);

  /// The picture at these displacements.
  /// \param displacements  [mats] m from rest along x of the section; what is not finite is drawn
  /// at
  ///                       rest
  const visualization_msgs::MarkerArray& draw(const std::vector<float>& displacements,
                                              const ::ros::Time& stamp);

  /// Wipes what an earlier model left.
  static visualization_msgs::MarkerArray eraseAll();

 private:
  using Indices = std::vector<std::size_t>;
  void addMarkers(const scene::Scene& scene, std::size_t section, int type, const Indices& mats);

  struct Module {
    Eigen::Vector3d ground;  // its place at x = 0, in frame model
    Eigen::Vector3d step;    // how far a metre of x is drawn, in frame model
    double rest_x = 0.0;
  };
  std::vector<Module> modules_;  // [mats]
  std::vector<Indices> points_;  // [markers] mats in the order of the points
  visualization_msgs::MarkerArray array_;
};

}  // namespace ergotic::node
