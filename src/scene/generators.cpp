// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generators.hpp"

#include <cmath>
#include <utility>

#include "ergotic/scene/chaplet.hpp"

namespace ergotic::scene {
namespace {

/// Height of a string held at `at` (0...1), at the place `u` (0...1).
double triangle(double u, double at, double height) {
  return height * (u <= at ? u / at : (1.0 - u) / (1.0 - at));
}

Mat stringMat(const StringSpec& spec, int index) {
  const double u = static_cast<double>(index) / (spec.masses + 1);
  const Eigen::Vector2d at = (1.0 - u) * spec.from + u * spec.to;
  Mat mat;
  mat.name = spec.name + "." + std::to_string(index);
  mat.section = spec.section;
  mat.rest.y() = at.x();
  mat.rest.z() = at.y();
  mat.place = spec.place;
  if (index == 0 || index == spec.masses + 1) {
    mat.type = MatType::kGround;
    return mat;
  }
  mat.type = spec.loss ? MatType::kCell : MatType::kMass;
  mat.mass = spec.mass;
  mat.damping = spec.loss.value_or(Value{});
  mat.position.x() = spec.pluck ? triangle(u, spec.pluck->x(), spec.pluck->y()) : 0.0;
  return mat;
}

Lia generatedLink(const std::string& name, int index, int a, int b, Place place) {
  Lia lia;
  lia.name = name + ".link." + std::to_string(index);
  lia.a = a;
  lia.b = b;
  lia.place = place;
  return lia;
}

}  // namespace

Value stringStiffness(int masses, const Value& mass, double frequency_hz) {
  const double root = M_PI * frequency_hz / std::sin(M_PI / (2.0 * (masses + 1)));
  return root * root * mass;
}

void addString(SceneBuilder& builder, const StringSpec& spec) {
  const int count = spec.masses + 2;
  builder.reserve(static_cast<std::size_t>(count), static_cast<std::size_t>(count - 1), spec.place);
  const int first = static_cast<int>(builder.scene().mats.size());
  for (int i = 0; i < count; ++i) {
    builder.add(stringMat(spec, i));
  }
  for (int i = 0; i + 1 < count; ++i) {
    Lia lia = generatedLink(spec.name, i, first + i, first + i + 1, spec.place);
    lia.stiffness = spec.stiffness;
    lia.damping = spec.damping;
    builder.add(std::move(lia));
  }
  StringInfo info;
  info.name = spec.name;
  info.first = first;
  info.count = count;
  info.mass = spec.mass;
  info.stiffness = spec.stiffness;
  info.damping = spec.damping;
  info.loss = spec.loss.value_or(Value{});
  builder.add(std::move(info));
  builder.add(Grid{spec.name, first, count, 1});
}

void addChaplet(SceneBuilder& builder, const ChapletSpec& spec) {
  const double nyquist = M_PI * builder.scene().gestural_rate_hz;  // wN, rad/s
  const Mat carrier = builder.scene().mats[static_cast<std::size_t>(spec.from)];

  int previous = spec.from;
  int index = 0;
  for (const ChapletStage& stage : kChapletC2) {
    Mat mat;
    mat.name = spec.name + "." + std::to_string(index);
    mat.section = spec.section;
    mat.mass = stage.mass * spec.mass;
    mat.rest.x() = carrier.rest.x();
    mat.position.x() = carrier.position.x();
    mat.rest.y() = spec.at.x();
    mat.rest.z() = spec.at.y();
    mat.place = spec.place;
    const int added = builder.add(std::move(mat));
    Lia lia = generatedLink(spec.name, index, previous, added, spec.place);
    lia.stiffness = stage.stiffness * nyquist * nyquist * spec.mass;
    lia.damping = stage.damping * nyquist * spec.mass;
    builder.add(std::move(lia));
    previous = added;
    ++index;
  }
}

}  // namespace ergotic::scene
