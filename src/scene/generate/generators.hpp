// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

/// A string between two fixed points: mats `name.0` ... `name.<masses + 1>`, of which the first and
/// the last are grounds, and links `name.link.0` ... `name.link.<masses>`; those of a coarse string
/// in the order of ergotic/scene/coarse_string.hpp. It is a grid of one row.
struct StringSpec {
  std::string name;
  int section = 0;
  int masses = 1;  ///< moving ones
  Value mass;      ///< of each, kg
  Value stiffness;
  Value damping;              ///< of each link
  std::optional<Value> loss;  ///< of each mass to the ground
  /// Coarse: the fundamental, Hz, > 0; 0: ordinary. A coarse string starts with the springs of the
  /// ordinary one, the others being 0, until its stiffnesses are fitted.
  double corrected_hz = 0.0;
  double rest_length_ratio = 0.0;     ///< rest length of a link / its length at rest; not scalar
  Scheme scheme = Scheme::kExplicit;  ///< of links with a rest length
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< rest of the first ground, m
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< rest of the last ground, m
  /// Where (0...1) and how high (m) it is held at start: along x, in a plane or in space along y.
  std::optional<Eigen::Vector2d> pluck;
  Place place;
};

/// Stiffness of the links with which the undamped string of `masses` moving masses `mass` has its
/// fundamental at `frequency_hz`, in continuous time: K = M (pi f / sin(pi / (2 (N+1))))^2.
Value stringStiffness(int masses, const Value& mass, double frequency_hz);

/// Appends the string, its modules and links. \throws TextError if a name is taken
void addString(SceneBuilder& builder, const StringSpec& spec);

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

/// The low-pass chaplet C2: two masses `name.0`, `name.1` and two links `name.link.0`,
/// `name.link.1` hung onto a module that moves at the gestural rate. The last mass is what touches
/// the structure.
struct ChapletSpec {
  std::string name;
  int from = 0;  ///< index of the module that carries it
  int section = 0;
  Value mass;  ///< of both together, kg
  Eigen::Vector2d at{0.0, 0.0};
  Place place;
};

/// Appends the chaplet, tuned to half the scene's gestural rate. \throws TextError if a name is
/// taken
void addChaplet(SceneBuilder& builder, const ChapletSpec& spec);

}  // namespace ergotic::scene
