// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

enum class MeshEdges {
  kFixed,    ///< all modules of the outermost rows and columns are grounds
  kFree,     ///< none
  kCorners,  ///< only those in the corners
};

/// A net: mats `name.<row>.<column>` and links `name.link.<n>`, none between two grounds. Module by
/// module, row by row, they are those to the next column, to the next row and, if there are
/// diagonals, to the next column of the next row and to the previous column of the next row.
struct MeshSpec {
  std::string name;
  int section = 0;
  int rows = 2;
  int columns = 2;
  Value mass;                               ///< of each, kg
  Value stiffness;                          ///< of the links along rows and columns
  Value damping;                            ///< of every link
  std::optional<Value> diagonal_stiffness;  ///< none: no diagonals
  MeshEdges edges = MeshEdges::kFixed;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< rest of the first module, m
  /// m; columns follow each other along x and rows along y, in scalar sections y and z.
  double spacing = 1.0;
  double rest_length_ratio = 0.0;     ///< rest length of a link / its length at rest; not scalar
  Scheme scheme = Scheme::kExplicit;  ///< of links with a rest length
  Place place;
};

/// Appends the mesh, its modules and links. \throws TextError if a name is taken
void addMesh(SceneBuilder& builder, const MeshSpec& spec);

}  // namespace ergotic::scene
