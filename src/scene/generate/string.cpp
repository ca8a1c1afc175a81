// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/string.hpp"

#include <cmath>
#include <utility>

#include "ergotic/scene/coarse_string.hpp"
#include "scene/generate/generated.hpp"

namespace ergotic::scene {
namespace {

/// Height of a string held at `at` (0...1), at the place `u` (0...1).
double triangle(double u, double at, double height) {
  return height * (u <= at ? u / at : (1.0 - u) / (1.0 - at));
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

}  // namespace

Value stringStiffness(int masses, const Value& mass, double frequency_hz) {
  const double root = M_PI * frequency_hz / std::sin(M_PI / (2.0 * (masses + 1)));
  return root * root * mass;
}

void addString(SceneBuilder& builder, const StringSpec& spec) {
  const int count = spec.masses + 2;
  const int links = spec.coarse ? coarseLinks(spec.masses) : spec.masses + 1;
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
  info.frequency_hz = spec.frequency_hz;
  info.coarse = spec.coarse;
  info.rest_length_ratio = spec.rest_length_ratio;
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
    const CoarseLink ends = spec.coarse ? coarseLink(spec.masses, i) : CoarseLink{i, i + 1, {}};
    Lia lia = generatedLink(link_stem, i, info.first + ends.a, info.first + ends.b, spec.place);
    if (i <= spec.masses) {
      lia.stiffness = spec.stiffness;
      lia.damping = spec.damping;
      lia.rest_length = rest_length;
      lia.scheme = spec.scheme;
    }
    builder.add(std::move(lia));
  }
  builder.add(Grid{spec.name, info.first, count, 1, spec.place});
  builder.add(std::move(info));
}

}  // namespace ergotic::scene
