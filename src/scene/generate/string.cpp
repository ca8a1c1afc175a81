// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/string.hpp"

#include <cmath>
#include <utility>

#include "ergotic/scene/coarse_string.hpp"
#include "scene/generate/bend.hpp"
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
  const bool loses = spec.loss || (spec.wish && !spec.wish->t60.empty());
  mat.type = loses ? MatType::kCell : MatType::kMass;
  mat.matched = loses;
  mat.mass = spec.mass;
  mat.damping = spec.loss.value_or(Value{});
  if (spec.pluck) {
    const int transverse = dimensionsOf(builder.scene().sectionOf(mat).geometry) > 1 ? 1 : 0;
    mat.position[transverse] += triangle(u, spec.pluck->x(), spec.pluck->y());
  }
  return mat;
}

StringInfo infoOf(const SceneBuilder& builder, const StringSpec& spec) {
  StringInfo info;
  info.name = spec.name;
  info.first = static_cast<int>(builder.scene().mats.size());
  info.first_lia = static_cast<int>(builder.scene().lias.size());
  info.count = spec.masses + 2;
  info.mass = spec.mass;
  info.stiffness = spec.stiffness;
  info.damping = spec.damping;
  info.loss = spec.loss.value_or(Value{});
  info.frequency_hz = spec.frequency_hz;
  info.coarse = spec.coarse;
  info.rest_length_ratio = spec.rest_length_ratio;
  return info;
}

/// Adds a bend around each mass: K s^2 of a mode, where the springs give K s.
void addStringBends(SceneBuilder& builder, const StringSpec& spec, int first) {
  const Name stem(spec.name + ".bend.");
  for (int i = 0; i < spec.masses; ++i) {
    Bend bend;
    bend.name = stem.numbered(i);
    bend.ends = {{first + i, 1.0}, {first + i + 1, -2.0}, {first + i + 2, 1.0}};
    bend.stiffness = spec.mass;
    bend.place = spec.place;
    addBend(builder, std::move(bend));
  }
}

void addStringLinks(SceneBuilder& builder,
                    const StringSpec& spec,
                    int first,
                    const Value& stiffness,
                    const Value& damping) {
  const int links = spec.coarse ? coarseLinks(spec.masses) : spec.masses + 1;
  const int moving =
      dimensionsOf(builder.scene().sections[static_cast<std::size_t>(spec.section)].geometry);
  const double rest_length =
      spec.rest_length_ratio * (spec.to - spec.from).head(moving).norm() / (spec.masses + 1);
  const Name link_stem = linkStem(spec.name);
  for (int i = 0; i < links; ++i) {
    const CoarseLink ends = spec.coarse ? coarseLink(spec.masses, i) : CoarseLink{i, i + 1, {}};
    Lia lia = generatedLink(link_stem, i, first + ends.a, first + ends.b, spec.place);
    if (i <= spec.masses) {
      lia.stiffness = stiffness;
      lia.damping = damping;
      lia.rest_length = rest_length;
      lia.scheme = spec.scheme;
    }
    builder.add(std::move(lia));
  }
}

/// Adds a string that is tuned as a body: springs and dampers of equal weight, and bends.
void addStringBody(SceneBuilder& builder, const StringSpec& spec, Tuning body) {
  const Value damping = spec.wish->t60.size() > 1 ? spec.mass : Value{};
  addStringLinks(builder, spec, body.first_mat, spec.mass, damping);
  if (spec.wish->inharmonicity > 0.0) {
    addStringBends(builder, spec, body.first_mat);
  }
  finishBody(builder, std::move(body), *spec.wish);
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
  StringInfo info = infoOf(builder, spec);
  Tuning body = beginBody(builder, spec.name, spec.place);
  const Name stem(spec.name + ".");
  for (int i = 0; i < count; ++i) {
    builder.add(stringMat(builder, spec, stem, i));
  }
  builder.add(Grid{spec.name, info.first, count, 1, spec.place});
  if (spec.wish) {
    addStringBody(builder, spec, std::move(body));
    return;
  }
  addStringLinks(builder, spec, info.first, spec.stiffness, spec.damping);
  builder.add(std::move(info));
}

}  // namespace ergotic::scene
