// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "rviz/model_bodies.hpp"
#include "rviz/model_light.hpp"
#include "rviz/model_motion.hpp"
#include "rviz/model_shape.hpp"

namespace ergotic::panel {

/// Vertex in the format of the renderer: 16 bytes.
struct MeshVertex {
  float x, y, z;         ///< m, frame `model`
  std::uint32_t colour;  ///< see colourOf
};

/// View of a mesh.
struct MeshView {
  Eigen::Vector3f eye = Eigen::Vector3f::Zero();  ///< position of the camera, frame `model`
  bool by_section = false;                        ///< colours of sections, not of looks
  bool is_stale = false;                          ///< greyed
};

/// The vertices of a model and what joins them: surfaces, tubes, bars and bodies of triangles, thin
/// things of lines and points. The indices stay as they are as long as the model plays; the
/// vertices are made anew for each picture. Thread: one
class ModelMesh {
 public:
  /// Above it strings are lines: each vertex has its price.
  static constexpr std::size_t kMaxTubeModules = 2000;

  ModelMesh() = default;
  /// \param motion  where the modules rest \param thickness  of strings and bodies, 1: as usual
  /// \param has_links  whether links that are no part of a body are drawn
  /// \pre isConsistent(structure)
  ModelMesh(const ModelStructure& structure,
            const ModelShape& shape,
            const ModelMotion& motion,
            double thickness,
            bool has_links);

  std::size_t vertices() const { return vertices_; }
  const ModuleIndices& triangles() const { return triangles_; }  ///< [][3] vertices
  const ModuleIndices& lines() const { return lines_; }          ///< [][2] vertices
  const ModuleIndices& points() const { return points_; }        ///< [] vertices

  /// \param out  [vertices()], written once and in order, never read: it may be the renderer's
  void fill(const ModelMotion& motion, const MeshView& view, MeshVertex* out);

 private:
  struct Row {
    ModuleIndices modules;
    float radius = 0.0F;  // m, half the width of a bar
  };
  class Filling;

  void measure(const ModelMotion& motion, const ModelShape& shape);
  void addSurfaces(const ModelShape& shape);
  void addTubes(const ModelShape& shape, float thickness);
  void addBars(const ModelShape& shape, const ModelMotion& motion);
  void addBodies(const ModelStructure& structure, const ModelShape& shape, float thickness);
  void addLinks(const ModelShape& shape);
  void addRim();
  void addThinStrings(const ModelShape& shape);
  void addSmallBodies(const ModelShape& shape);
  std::uint32_t dotOf(std::uint32_t module);
  void addTriangles(std::uint32_t first, const ModuleIndices& corners);

  std::vector<Tint> tints_;          // [modules]
  std::vector<Tint> section_tints_;  // [modules]
  Eigen::Vector3f middle_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f up_ = Eigen::Vector3f::UnitX();
  float size_ = 0.1F;  // m, from corner to corner of what the model fills

  // In the order of their vertices.
  ModuleIndices surface_;          // modules
  ModuleIndices surface_corners_;  // [][3] indices into it
  std::vector<Row> tubes_;
  std::vector<Row> bars_;
  std::vector<DrawnBody> bodies_;
  ModuleIndices dots_;    // modules
  ModuleIndices dot_of_;  // [modules] their vertices
  std::size_t first_dot_ = 0;

  std::size_t vertices_ = 0;
  ModuleIndices triangles_;
  ModuleIndices lines_;
  ModuleIndices points_;
  std::vector<Eigen::Vector3f> normals_;  // of the surface, while it is filled
};

}  // namespace ergotic::panel
