// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/mesh.hpp"

#include <utility>

#include "scene/generate/generated.hpp"

namespace ergotic::scene {
namespace {

/// Step from a module of a mesh to a neighbour.
struct MeshStep {
  int row;
  int column;
};
constexpr MeshStep kMeshSteps[] = {{0, 1}, {1, 0}, {1, 1}, {1, -1}};

Mat meshMat(
    const SceneBuilder& builder, const MeshSpec& spec, const Name& stem, int row, int column) {
  const bool scalar = builder.scene().sections[static_cast<std::size_t>(spec.section)].geometry ==
                      Geometry::kScalar;
  // In scalar sections component 0 is what moves, so that the mesh lies in the other two.
  Eigen::Vector3d rest = spec.at;
  rest[scalar ? 1 : 0] += column * spec.spacing;
  rest[scalar ? 2 : 1] += row * spec.spacing;
  Mat mat = generatedMat(builder, spec.section, stem.numbered(row, column), rest, spec.place);
  const bool row_edge = row == 0 || row == spec.rows - 1;
  const bool column_edge = column == 0 || column == spec.columns - 1;
  const bool fixed = spec.edges == MeshEdges::kFixed     ? row_edge || column_edge
                     : spec.edges == MeshEdges::kCorners ? row_edge && column_edge
                                                         : false;
  mat.type = fixed ? MatType::kGround : MatType::kMass;
  mat.mass = spec.mass;
  return mat;
}

/// \param next  number of the link, raised if it is made
void addMeshLink(SceneBuilder& builder,
                 const MeshSpec& spec,
                 const Name& stem,
                 int first,
                 const MeshStep& from,
                 const MeshStep& step,
                 int& next) {
  const int row = from.row + step.row;
  const int column = from.column + step.column;
  const bool diagonal = step.row != 0 && step.column != 0;
  if (row >= spec.rows || column < 0 || column >= spec.columns ||
      (diagonal && !spec.diagonal_stiffness)) {
    return;
  }
  const int a = first + from.row * spec.columns + from.column;
  const int b = first + row * spec.columns + column;
  const Mat& mat_a = builder.scene().mats[static_cast<std::size_t>(a)];
  const Mat& mat_b = builder.scene().mats[static_cast<std::size_t>(b)];
  if (mat_a.type == MatType::kGround && mat_b.type == MatType::kGround) {
    return;
  }
  const Geometry geometry = builder.scene().sectionOf(mat_a).geometry;
  const int moving = dimensionsOf(geometry);
  Lia lia = generatedLink(stem, next++, a, b, spec.place);
  lia.stiffness = diagonal ? *spec.diagonal_stiffness : spec.stiffness;
  lia.damping = spec.damping;
  lia.rest_length =
      spec.rest_length_ratio * (mat_a.rest.head(moving) - mat_b.rest.head(moving)).norm();
  lia.scheme = spec.scheme;
  builder.add(std::move(lia));
}

}  // namespace

void addMesh(SceneBuilder& builder, const MeshSpec& spec) {
  const std::size_t count =
      static_cast<std::size_t>(spec.rows) * static_cast<std::size_t>(spec.columns);
  builder.reserve(count, (spec.diagonal_stiffness ? 4 : 2) * count, spec.place);
  const int first = static_cast<int>(builder.scene().mats.size());
  const Name stem(spec.name + ".");
  for (int row = 0; row < spec.rows; ++row) {
    for (int column = 0; column < spec.columns; ++column) {
      builder.add(meshMat(builder, spec, stem, row, column));
    }
  }
  const Name link_stem = linkStem(spec.name);
  int next = 0;
  for (int row = 0; row < spec.rows; ++row) {
    for (int column = 0; column < spec.columns; ++column) {
      for (const MeshStep& step : kMeshSteps) {
        addMeshLink(builder, spec, link_stem, first, {row, column}, step, next);
      }
    }
  }
  builder.add(Grid{spec.name, first, spec.columns, spec.rows, spec.place});
}

}  // namespace ergotic::scene
