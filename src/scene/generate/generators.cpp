// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/generators.hpp"

#include <cmath>
#include <utility>

#include "ergotic/scene/coarse_string.hpp"
#include "ergotic/scene/generate/chaplet.hpp"

namespace ergotic::scene {
namespace {

/// Height of a string held at `at` (0...1), at the place `u` (0...1).
double triangle(double u, double at, double height) {
  return height * (u <= at ? u / at : (1.0 - u) / (1.0 - at));
}

/// A module at rest at its place.
Mat generatedMat(
    const SceneBuilder& builder, int section, Name name, const Eigen::Vector3d& rest, Place place) {
  Mat mat;
  mat.name = std::move(name);
  mat.section = section;
  mat.rest = rest;
  const int moving = dimensionsOf(builder.scene().sectionOf(mat).geometry);
  mat.position.head(moving) = rest.head(moving);
  mat.place = place;
  return mat;
}

Mat stringMat(const SceneBuilder& builder, const StringSpec& spec, const Name& stem, int index) {
  const double u = static_cast<double>(index) / (spec.masses + 1);
  Mat mat = generatedMat(builder, spec.section, stem.numbered(index),
                         (1.0 - u) * spec.from + u * spec.to, spec.place);
  if (index == 0 || index == spec.masses + 1) {
    mat.type = MatType::kGround;
    return mat;
  }
  mat.type = spec.loss ? MatType::kCell : MatType::kMass;
  mat.matched = spec.loss.has_value();
  mat.mass = spec.mass;
  mat.damping = spec.loss.value_or(Value{});
  if (spec.pluck) {
    const int transverse = dimensionsOf(builder.scene().sectionOf(mat).geometry) > 1 ? 1 : 0;
    mat.position[transverse] += triangle(u, spec.pluck->x(), spec.pluck->y());
  }
  return mat;
}

Name linkStem(const std::string& generator) {
  return generator + ".link.";
}

/// \param stem  of all links of the generator
Lia generatedLink(const Name& stem, int index, int a, int b, Place place) {
  Lia lia;
  lia.name = stem.numbered(index);
  lia.a = a;
  lia.b = b;
  lia.place = place;
  return lia;
}

/// From a module of a mesh to a neighbour.
struct MeshStep {
  int row;
  int column;
};
constexpr MeshStep kMeshSteps[] = {{0, 1}, {1, 0}, {1, 1}, {1, -1}};

Mat meshMat(
    const SceneBuilder& builder, const MeshSpec& spec, const Name& stem, int row, int column) {
  const bool scalar = builder.scene().sections[static_cast<std::size_t>(spec.section)].geometry ==
                      Geometry::kScalar;
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

Value stringStiffness(int masses, const Value& mass, double frequency_hz) {
  const double root = M_PI * frequency_hz / std::sin(M_PI / (2.0 * (masses + 1)));
  return root * root * mass;
}

void addString(SceneBuilder& builder, const StringSpec& spec) {
  const bool coarse = spec.corrected_hz > 0.0;
  const int count = spec.masses + 2;
  const int links = coarse ? coarseLinks(spec.masses) : spec.masses + 1;
  builder.reserve(static_cast<std::size_t>(count), static_cast<std::size_t>(links), spec.place);
  StringInfo info;
  info.name = spec.name;
  info.first = static_cast<int>(builder.scene().mats.size());
  info.first_lia = static_cast<int>(builder.scene().lias.size());
  info.count = count;
  info.mass = spec.mass;
  info.stiffness = spec.stiffness;
  info.damping = spec.damping;
  info.loss = spec.loss.value_or(Value{});
  info.corrected_hz = spec.corrected_hz;
  const Name stem(spec.name + ".");
  for (int i = 0; i < count; ++i) {
    builder.add(stringMat(builder, spec, stem, i));
  }
  const int moving =
      dimensionsOf(builder.scene().sections[static_cast<std::size_t>(spec.section)].geometry);
  const double rest_length =
      spec.rest_length_ratio * (spec.to - spec.from).head(moving).norm() / (spec.masses + 1);
  const Name link_stem = linkStem(spec.name);
  for (int i = 0; i < links; ++i) {
    const CoarseLink ends = coarse ? coarseLink(spec.masses, i) : CoarseLink{i, i + 1, {}};
    Lia lia = generatedLink(link_stem, i, info.first + ends.a, info.first + ends.b, spec.place);
    if (i <= spec.masses) {
      lia.stiffness = spec.stiffness;
      lia.damping = spec.damping;
      lia.rest_length = rest_length;
      lia.scheme = spec.scheme;
    }
    builder.add(std::move(lia));
  }
  builder.add(Grid{spec.name, info.first, count, 1});
  builder.add(std::move(info));
}

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
  builder.add(Grid{spec.name, first, spec.columns, spec.rows});
}

void addChaplet(SceneBuilder& builder, const ChapletSpec& spec) {
  const double nyquist = M_PI * builder.scene().gestural_rate_hz;  // wN, rad/s
  const Mat carrier = builder.scene().mats[static_cast<std::size_t>(spec.from)];

  int previous = spec.from;
  int index = 0;
  for (const ChapletStage& stage : kChapletC2) {
    Mat mat;
    mat.name = Name(spec.name + ".").numbered(index);
    mat.section = spec.section;
    mat.mass = stage.mass * spec.mass;
    mat.rest.x() = carrier.rest.x();
    mat.position.x() = carrier.position.x();
    mat.rest.y() = spec.at.x();
    mat.rest.z() = spec.at.y();
    mat.place = spec.place;
    const int added = builder.add(std::move(mat));
    Lia lia = generatedLink(linkStem(spec.name), index, previous, added, spec.place);
    lia.stiffness = stage.stiffness * nyquist * nyquist * spec.mass;
    lia.damping = stage.damping * nyquist * spec.mass;
    builder.add(std::move(lia));
    previous = added;
    ++index;
  }
}

}  // namespace ergotic::scene
