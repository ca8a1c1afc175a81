// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "at.hpp"
#include "physics/settling/steps.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::Lia;
using scene::Mat;
using scene::MatType;
using scene::Scene;

/// True if part of it is linear: it has no rest length, or is stretched where its ends rest.
bool isPartlyLinear(const Lia& lia, double length) {
  return lia.rest_length == 0.0 ? lia.stiffness.factor != 0.0 : lia.rest_length < length;
}

/// Length of a link at rest, m; 0 if it may be stretched otherwise than along the line of its ends.
double lengthOf(const Scene& scene, const Lia& lia) {
  const Mat& a = scene.mats[at(lia.a)];
  const Mat& b = scene.mats[at(lia.b)];
  const Geometry geometry = scene.sectionOf(a).geometry;
  if (a.section != b.section || geometry == Geometry::kScalar || a.type == MatType::kPoint ||
      b.type == MatType::kPoint) {
    return 0.0;
  }
  return (a.rest - b.rest).head(dimensionsOf(geometry)).norm();
}

}  // namespace

void splitSprings(Scene& scene) {
  const std::size_t count = scene.lias.size();
  for (std::size_t l = 0; l < count; ++l) {
    Lia& lia = scene.lias[l];
    const double length = lengthOf(scene, lia);
    if (lia.type != scene::LiaType::kSpringDamper || lia.scheme != scene::Scheme::kEnergyStable ||
        !isPartlyLinear(lia, length)) {
      continue;
    }
    const double slack = lia.rest_length > 0.0 ? lia.rest_length / length : 0.0;
    Lia tension = lia;
    tension.name = scene::Name(lia.name + ".tension");
    tension.scheme = scene::Scheme::kExplicit;
    tension.stiffness = (1.0 - slack) * lia.stiffness;
    tension.rest_length = 0.0;
    const bool is_straight = scene.sectionOf(scene.mats[at(lia.a)]).geometry == Geometry::kLine &&
                             scene.sectionOf(scene.mats[at(lia.b)]).geometry == Geometry::kLine;
    (is_straight ? lia : tension).damping = {};
    lia.stiffness = slack * lia.stiffness;
    lia.rest_length = slack > 0.0 ? length : 0.0;
    scene.lias.push_back(std::move(tension));
  }
}

}  // namespace ergotic::physics
