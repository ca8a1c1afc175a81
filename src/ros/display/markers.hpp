// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <geometry_msgs/Point.h>
#include <visualization_msgs/MarkerArray.h>

#include "ergotic/scene/scene.hpp"

namespace ergotic::node {

/// Whether a module is a mode that is not drawn, as the outline of its body shows it.
bool isModeOfOutline(const scene::Scene& scene, int mat);

/// Draws a scene for rviz: per section one POINTS and one LINE_LIST, in chunks of at most
/// `kChunkPoints` points (rviz slows down beyond), in frame `model` unless it is told another.
class Markers {
 public:
  static constexpr std::size_t kChunkPoints = 16000;
  /// Time after which an erased marker vanishes even if the erasing message was missed, s.
  static constexpr double kLifetimeS = 1.0;

  /// \param zoom  of x about x = 0 where modules move along x alone, as maps exaggerate height:
  ///              strings move by millimetres. What touches in the model touches in the picture.
  ///              Planes and spaces are true to scale
  Markers(const scene::Scene& scene, double zoom);

  void setFrame(const std::string& frame);

  /// The picture at these displacements.
  /// \param displacements  [Scene::coordinates] m from rest; a module of which one is not finite is
  ///                       drawn at rest
  const visualization_msgs::MarkerArray& draw(const std::vector<float>& displacements,
                                              const ::ros::Time& stamp);

  /// Wipes what an earlier model left.
  static visualization_msgs::MarkerArray eraseAll(const std::string& frame);

 private:
  using Indices = std::vector<std::size_t>;
  void addMarkers(const scene::Scene& scene, std::size_t section, int type, const Indices& mats);

  struct Module {
    Eigen::Vector3d rest;
    std::size_t section = 0;
    std::size_t first = 0;  // of its displacements
    int dimensions = 1;
  };
  geometry_msgs::Point place(const Module& module, const std::vector<float>& displacements) const;

  std::vector<Eigen::Affine3d> drawing_;  // [sections] from its frame to the picture
  std::vector<Module> modules_;           // [mats]
  std::vector<Indices> points_;           // [markers] mats in the order of the points
  visualization_msgs::MarkerArray array_;
};

}  // namespace ergotic::node
